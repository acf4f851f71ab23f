"""Explain exceptions that rclpy raises inside itself for an argument of the wrong kind in the student's call."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_other_object import CREATE_OBJECT
from grader.checks.causes.why_rate import callbacks_of
from grader.common.words import shorten
from grader.submission.constants import dotted, written

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

GROUP_OF_TIMER = 2
"""The position (from 0) of the callback group in a call to create_timer. create_subscription, for example, takes
the callback group only by name."""
GROUPS = ("MutuallyExclusiveCallbackGroup", "ReentrantCallbackGroup")
NOT_A_GROUP = re.compile(r"has no attribute '(?:handle|add_entity|can_execute)'|CallbackGroup\.add_entity\(\) missing")
KEYWORD = re.compile(r"got an unexpected keyword argument '(?P<name>\w+)'")
OF_ACTIONLIB = (
    "done_cb, active_cb and feedback_cb belong to actionlib, a library of ROS 1. In ROS 2, send_goal_async has the "
    "argument feedback_callback, and add_done_callback takes the method that gets the goal handle."
)
KEYWORDS = {"done_cb": OF_ACTIONLIB, "active_cb": OF_ACTIONLIB, "feedback_cb": OF_ACTIONLIB}
"""Maps a keyword of a ROS 1 library to a sentence about its replacement in ROS 2."""
OF_A_LIST = re.compile(r"'list' object has no attribute '(?:name|value)'")
SUBSCRIPT = re.compile(r"'(?P<type>[A-Z]\w*)' object is not subscriptable")
BY_POSITION = re.compile(r"(?P<of>[A-Z]\w*)\.__init__\(\) takes 1 positional argument but \d+ were given")
INTERFACES = (".msg", ".srv", ".action")
AUTOMATIC = "automatically_declare_parameters_from_overrides"
OF_RCLPY = ("use_sim_time", "start_type_description_service")
"""The parameters that rclpy declares for every node."""


def why_rclpy_refused(scene: CrashScene) -> Cause | None:
    """Return the cause if an argument in a call of rclpy or of a message class has the wrong kind, else None."""
    return (
        _group(scene)
        or _keyword(scene)
        or _field_by_index(scene)
        or _by_position(scene)
        or _list_of_parameters(scene)
        or _value_of_parameter(scene)
    )


def _group(scene: CrashScene) -> Cause | None:
    """Return the cause if something other than a callback group was passed as the callback group, else None."""
    if not NOT_A_GROUP.search(scene.crash.message) or scene.module is None:
        return None
    timers = scene.calls_on_line("create_timer")
    by_place = [call.args[GROUP_OF_TIMER] for call in timers if len(call.args) > GROUP_OF_TIMER]
    calls = [node for node in scene.on_line if isinstance(node, ast.Call)]
    by_name = [each.value for call in calls for each in call.keywords if each.arg == "callback_group"]
    for given in (*by_name, *by_place):
        value = written(given, scene.module.names)
        group = (dotted(value) or "").rpartition(".")[2] if value is not None else ""
        if group in GROUPS:
            return Cause("class-for-object", f"{group} is a class. {CREATE_OBJECT}", scene.at(value))
    for call in timers:
        if [type(getattr(each, "value", None)) for each in call.args[:2]] == [int, int]:
            number = f"{ast.unparse(call.args[0])}.{ast.unparse(call.args[1])}"
            text = f"A comma separates two numbers. Write a dot in a decimal number: {shorten(number)}."
            return Cause("comma-for-dot", text, scene.at(call))
    if by_place:
        text = (
            "The third argument of create_timer is a callback group. A timer passes no arguments to its callback. "
            "Store the values in self."
        )
        return Cause("too-many-arguments", text, scene.at(by_place[0]))
    return None


def _keyword(scene: CrashScene) -> Cause | None:
    """Return the cause if a call has a keyword that another library uses for this argument, else None."""
    found = KEYWORD.search(scene.crash.message)
    if found is None or found["name"] not in KEYWORDS:
        return None
    return Cause("unexpected-keyword", KEYWORDS[found["name"]])


def _list_of_parameters(scene: CrashScene) -> Cause | None:
    """Return the cause if the callback for parameters uses its list as if it were one parameter, else None."""
    name = scene.function.name if scene.function is not None else ""
    callbacks = {callback for _, callback in callbacks_of(scene.evidence, "add_on_set_parameters_callback")}
    if name not in callbacks or not OF_A_LIST.search(scene.crash.message):
        return None
    text = f"{name} gets a list of parameters, even if only one is set. Use a loop over the list."
    return Cause("callback-parameters", text)


def _field_by_index(scene: CrashScene) -> Cause | None:
    """Return the cause if a field of a message is read with square brackets, else None."""
    found = SUBSCRIPT.search(scene.crash.message)
    if found is None or not _is_interface(scene, found["type"]):
        return None
    text = f"A {found['type']} is a message, not a dictionary. Write a dot before the name of a field, as in msg.x."
    return Cause("message-field", text)


def _by_position(scene: CrashScene) -> Cause | None:
    """Return the cause if a message was created with values without the names of their fields, else None."""
    found = BY_POSITION.search(scene.crash.message)
    if found is None or not _is_interface(scene, found["of"]):
        return None
    return Cause("message-arguments", "Create the message without arguments, then set its fields one by one.")


def _is_interface(scene: CrashScene, name: str) -> bool:
    """Return whether the file imports this class from a module of messages, services or actions."""
    return any(
        isinstance(node, ast.ImportFrom)
        and (node.module or "").endswith(INTERFACES)
        and name in [alias.name for alias in node.names]
        for node in scene.nodes
    )


def _value_of_parameter(scene: CrashScene) -> Cause | None:
    """Return the cause if a parameter is declared twice, or its default value has no parameter type, else None."""
    if scene.crash.error == "ParameterAlreadyDeclaredException":
        return _declared_twice(scene)
    if "The given value is not one of the allowed types" not in scene.crash.message:
        return None
    is_parameter = "rclpy.parameter.Parameter" in scene.crash.message
    if not scene.calls_on_line("declare_parameter") or (scene.calls_on_line("Parameter") and not is_parameter):
        return None  # the value of a Parameter, or one of the parameters in declare_parameters
    kind = "a Parameter" if is_parameter else "an object of another type"
    text = f"The second argument of declare_parameter is the default value, such as 1.0. Here it is {kind}."
    return Cause("parameter-type", text)


DECLARED = re.compile(r"already declared: \['(?P<name>[^']+)'")


def _declared_twice(scene: CrashScene) -> Cause:
    found = DECLARED.search(scene.crash.message)
    name = shorten(found["name"]) if found is not None else "This parameter"
    if name in OF_RCLPY:
        return Cause("parameter-twice", f"rclpy already declares {name} for every node. Do not declare it again.")
    for node in scene.nodes:
        if isinstance(node, ast.keyword) and node.arg == AUTOMATIC and getattr(node.value, "value", None) is True:
            text = (
                f"{node.arg} already declares each parameter that is set when the node starts. Remove this argument "
                "if you declare the parameters yourself."
            )
            return Cause("parameter-twice", text, scene.at(node.value))
    text = f"{name} is declared twice. Compare the names in the calls of declare_parameter."
    return Cause("parameter-twice", text)
