"""The groups and verbs of `ros2`, each with a one-line help text. The modules of the verbs are not imported."""

from __future__ import annotations

from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Mapping

_NONE: Mapping[str, str] = MappingProxyType({})


class Group(NamedTuple):
    """A command group, such as `topic`: the word after `ros2`.

    The class is not a dataclass, because importing dataclasses would slow down every command.

    `verbs` maps the words that may follow the group to their help texts. A group without verbs is a command. `flags`
    maps options that may come before the verb to their help texts. With `runs_itself`, the group also works without a
    verb.
    """

    about: str
    verbs: Mapping[str, str] = _NONE
    flags: Mapping[str, str] = _NONE
    runs_itself: bool = False


GROUPS = {
    "action": Group(
        "Various action related sub-commands",
        {
            "find": "Output a list of available actions of a given type",
            "info": "Print information about an action",
            "list": "Output a list of action names",
            "send_goal": "Send an action goal",
            "type": "Print a action's type",
        },
    ),
    "bag": Group(
        "Various rosbag related sub-commands",
        {
            "burst": "Burst data from a bag",
            "convert": "Given an input bag, write out a new bag with different settings",
            "info": "Print information about a bag to the screen",
            "play": "Play back ROS data from a bag",
            "record": "Record ROS data to a bag",
            "reindex": "Reconstruct metadata file for a bag",
        },
    ),
    "component": Group(
        "Various component related sub-commands",
        {
            "list": "Output a list of running containers and components",
            "load": "Load a component into a container node",
            "standalone": "Run a component into its own standalone container node",
            "types": "Output a list of components registered in the ament index",
            "unload": "Unload a component from a container node",
        },
    ),
    "daemon": Group(
        "Various daemon related sub-commands",
        {
            "start": "Start the daemon if it isn't running",
            "status": "Output the status of the daemon",
            "stop": "Stop the daemon if it is running",
        },
    ),
    "doctor": Group(
        "Check ROS setup and other potential issues",
        {"hello": "Check network connectivity between multiple hosts"},
        runs_itself=True,
    ),
    "interface": Group(
        "Show information about ROS interfaces",
        {
            "list": "List all interface types available",
            "package": "Output a list of available interface types within one package",
            "packages": "Output a list of packages that provide interfaces",
            "proto": "Output an interface prototype",
            "show": "Output the interface definition",
        },
    ),
    "launch": Group("Run a launch file"),
    "lifecycle": Group(
        "Various lifecycle related sub-commands",
        {
            "get": "Get lifecycle state for one or more nodes",
            "list": "Output a list of available transitions",
            "nodes": "Output a list of nodes with lifecycle",
            "set": "Trigger lifecycle state transition",
        },
    ),
    "multicast": Group(
        "Various multicast related sub-commands",
        {
            "receive": "Receive a single UDP multicast packet",
            "send": "Send a single UDP multicast packet",
        },
    ),
    "node": Group(
        "Various node related sub-commands",
        {
            "info": "Output information about a node",
            "list": "Output a list of available nodes",
        },
    ),
    "param": Group(
        "Various param related sub-commands",
        {
            "delete": "Delete parameter",
            "describe": "Show descriptive information about declared parameters",
            "dump": "Show all of the parameters of a node in a YAML file format",
            "get": "Get parameter",
            "list": "Output a list of available parameters",
            "load": "Load parameter file for a node",
            "set": "Set parameter",
        },
    ),
    "pkg": Group(
        "Various package related sub-commands",
        {
            "create": "Create a new ROS 2 package",
            "executables": "Output a list of package specific executables",
            "list": "Output a list of available packages",
            "prefix": "Output the prefix path of a package",
            "xml": "Output the XML of the package manifest or a specific tag",
        },
    ),
    "run": Group("Run a package specific executable"),
    "security": Group("Various security related sub-commands"),
    "service": Group(
        "Various service related sub-commands",
        {
            "call": "Call a service",
            "echo": "Echo a service",
            "find": "Output a list of available services of a given type",
            "info": "Print information about a service",
            "list": "Output a list of available services",
            "type": "Output a service's type",
        },
        {"--include-hidden-services": "include hidden services: a part of their name starts with _"},
    ),
    "topic": Group(
        "Various topic related sub-commands",
        {
            "bw": "Display bandwidth used by topic",
            "delay": "Display delay of topic from timestamp in header",
            "echo": "Output messages from a topic",
            "find": "Output a list of available topics of a given type",
            "hz": "Print the average publishing rate to screen",
            "info": "Print information about a topic",
            "list": "Output a list of available topics",
            "pub": "Publish a message to a topic",
            "type": "Print a topic's type",
        },
        {"--include-hidden-topics": "include hidden topics: a part of their name starts with _"},
    ),
    "wtf": Group(
        "Use `wtf` as alias to `doctor`",
        {"hello": "Check network connectivity between multiple hosts"},
        runs_itself=True,
    ),
}
