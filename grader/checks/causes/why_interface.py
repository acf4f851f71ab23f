"""Explain exceptions caused by the wrong use of interfaces: action and service types, their messages, and futures."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_attributes import NO_ATTRIBUTE
from grader.common.words import shorten

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

WRAPPED = {"_FeedbackMessage": "feedback", "_GetResult_Response": "result"}
"""Maps the end of a type name to the field of this type that contains the feedback or the result."""
OF_A_RESULT = ("status", "result")
NO_OBJECT = re.compile(r"^(Action|Service) classes can not be instantiated")
OF_AN_ACTION = re.compile(r"service type provided is not valid \(<class '\w+\.action\.")
PARTS = {"Action": "Goal", "Service": "Request"}
"""Maps each kind of interface to the part of it that a client fills in, for example a service to its Request."""
OF_A_TYPE = "_TYPE_SUPPORT"
"""The attribute that rclpy looks up in every interface type."""


def why_interface(scene: CrashScene) -> Cause | None:
    """Return the cause if the node used an interface type, a part of it or a future in the wrong way, else None."""
    whole = NO_OBJECT.match(scene.crash.message)
    if whole is not None:
        part = PARTS[whole[1]]
        text = f"You can create objects only of the parts of this type: add .{part} before the parentheses."
        return Cause("interface-part", text)
    if OF_AN_ACTION.search(scene.crash.message):
        text = "This is the type of an action. create_client is for services. For an action, use ActionClient."
        return Cause("wrong-type", text)
    match = NO_ATTRIBUTE.search(scene.crash.message)
    if match is None:
        return None
    owner, name = match["object"] or match["type"] or "", match["name"]
    if owner == "str" and name == OF_A_TYPE:
        return Cause("arguments-swapped", "A string was passed instead of the type. The type comes before the name.")
    if owner == "type" and name == OF_A_TYPE:
        text = "The type must be a class of ROS 2, such as Twist from geometry_msgs.msg, and not a class of Python."
        return Cause("wrong-type", text)
    if owner == "Future":
        text = (
            "This is a future. Its method result() returns what has arrived, such as a response. "
            f"Look for {shorten(name)} there."
        )
        return Cause("future-for-answer", text)
    inner = next((field for ending, field in WRAPPED.items() if owner.endswith(ending)), None)
    if inner is None or name in OF_A_RESULT:
        return None
    text = f"rclpy puts the {inner} into another message: look for {shorten(name)} in its field {inner}."
    return Cause("message-field", text)
