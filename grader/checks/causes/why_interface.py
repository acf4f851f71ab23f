"""Explain exceptions caused by the wrong use of interfaces: action and service types, their messages, and futures."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_attributes import NO_ATTRIBUTE
from grader.checks.causes.why_rate import callbacks_of
from grader.common.words import shorten

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

WRAPPED = {"_FeedbackMessage": "feedback", "_GetResult_Response": "result"}
"""Maps the end of a type name to the field of this type that contains the feedback or the result."""
OF_OTHER_FUTURES = ("wait", "get", "join", "then", "add_callback")
"""The methods of futures in other libraries and languages, which learners use instead of add_done_callback."""
OF_A_RESULT = ("status", "result")
NO_OBJECT = re.compile(r"^(Action|Service) classes can not be instantiated")
TAKE_A_TYPE = ("create_service", "create_client", "ActionClient", "create_publisher", "create_subscription")
"""The functions and classes that take an interface type."""
OF_A_MESSAGE = re.compile(r"service type provided is not valid \(<class '\w+\.msg\.")
OF_AN_ACTION = re.compile(r"service type provided is not valid \(<class '\w+\.action\.")
PARTS = {"Action": "Goal", "Service": "Request"}
"""Maps each kind of interface to the part of it that a client fills in, for example a service to its Request."""
OF_A_TYPE = "_TYPE_SUPPORT"
"""The attribute that rclpy looks up in every interface type."""


def why_interface(scene: CrashScene) -> Cause | None:
    """Return the cause if the node used an interface type, a part of it or a future in the wrong way, else None."""
    refused = _refused_type(scene)
    if refused is not None:
        return refused
    match = NO_ATTRIBUTE.search(scene.crash.message)
    if match is None:
        return None
    owner, name = match["object"] or match["type"] or "", match["name"]
    if owner == "str" and name == OF_A_TYPE:
        return Cause("arguments-swapped", "A string was passed instead of the type. The type comes before the name.")
    if owner == "type" and name == OF_A_TYPE:
        text = "The type must be a class of ROS 2, such as Twist from geometry_msgs.msg, and not a class of Python."
        return Cause("wrong-type", text)
    if name == "default_callback_group" and scene.calls_on_line("ActionClient"):
        text = "The first argument of ActionClient is the node. Inside a method of the node, write self."
        return Cause("crash", text)
    if owner == "Future":
        return _of_future(name)
    inner = next((field for ending, field in WRAPPED.items() if owner.endswith(ending)), None)
    if inner is None or name in OF_A_RESULT:
        return None
    text = f"rclpy puts the {inner} into another message: look for {shorten(name)} in its field {inner}."
    return Cause("message-field", text)


def _of_future(name: str) -> Cause:
    if name in OF_OTHER_FUTURES:
        text = f"A future has no method {shorten(name)}. Pass the method that needs the result to add_done_callback."
        return Cause("attribute-missing", text)
    text = (
        "This is a future. Its method result() returns what has arrived, such as a response. "
        f"Look for {shorten(name)} there."
    )
    return Cause("future-for-answer", text)


def _refused_type(scene: CrashScene) -> Cause | None:
    """Return the cause if an interface type cannot be called, or if a service was created with another type."""
    whole = NO_OBJECT.match(scene.crash.message)
    if whole is not None:
        makers = [name for name in TAKE_A_TYPE if scene.calls_on_line(name)]
        if makers:
            text = f"{makers[0]} needs the class itself. A class name with () creates an object: leave out the ()."
            return Cause("object-for-class", text)
        part = "Response" if _in_service(scene) else PARTS[whole[1]]
        text = f"You can create objects only of the parts of this type: add .{part} before the parentheses."
        return Cause("interface-part", text)
    if OF_AN_ACTION.search(scene.crash.message):
        maker = next((name for name in TAKE_A_TYPE if scene.calls_on_line(name)), "create_client")
        text = f"This is the type of an action. {maker} is for services. For an action, use ActionClient."
        return Cause("wrong-type", text)
    if OF_A_MESSAGE.search(scene.crash.message):
        return Cause(
            "wrong-type", "This is the type of a message. A service needs the type of a service, such as SetBool."
        )
    return None


def _in_service(scene: CrashScene) -> bool:
    """Return whether the line is in the callback of a service."""
    name = scene.function.name if scene.function is not None else ""
    return name in {callback for _, callback in callbacks_of(scene.evidence, "create_service")}
