"""The verb `param dump`: print all parameters of a node as a parameter file."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from grader.ros2.param.options import add_node, add_timeout

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_node(parser)
    add_timeout(parser)


def run(args: argparse.Namespace) -> int:
    """Print the parameter file, with an empty line at the end.

    Raises:
        Ros2Error: the node does not exist or does not respond.
    """
    from grader.ros2.param.parameter_client import parameters_of

    with parameters_of(args) as parameters:
        print(dumped(parameters.node_name, parameters.all_values()))
    return 0


def dumped(node_name: str, values: dict[str, Any]) -> str:
    """Return the values in the format of a parameter file. Each dot in a name starts a new level.

    If a node has a parameter `a` and a parameter `a.b`, `a` cannot contain a level, so that `a.b` is written as one
    key. `ros2 param load` and `--params-file` read such a key, too. The real `ros2 param dump` fails in this case.
    """
    import yaml

    tree: dict[str, Any] = {}
    for name, value in values.items():
        level, begin = tree, 0
        while (dot := name.find(".", begin)) >= 0 and name[:dot] not in values:
            level, begin = level.setdefault(name[begin:dot], {}), dot + 1
        level[name[begin:]] = value.tolist() if hasattr(value, "tolist") else value
    text: str = yaml.safe_dump({node_name: {"ros__parameters": tree}}, default_flow_style=False, sort_keys=True)
    return text
