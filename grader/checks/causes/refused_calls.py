"""Explain why rclpy rejected a type, a period, a callback or a second call to init."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_calls import callback_called
from grader.checks.edit import at
from grader.common.words import a_list
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

INNER_TYPE = re.compile(r"type provided is not valid .*\.(?P<type>\w+)_(?P<inner>Request|Response)'>")


def why_refused(scene: CrashScene) -> Cause | None:
    """Return the cause if rclpy rejected a type, a period, a callback or a second call to init, else None."""
    text = scene.crash.message
    if "must only be called once" in text:
        return Cause("init-twice", f"Call rclpy.init only once.{_calls_of_init(scene)}")
    if "context is invalid" in text:
        return Cause("no-init", "ROS 2 was used before rclpy.init or after rclpy.shutdown.")
    if "called for existing topic name" in text:
        return Cause("second-type", "A topic has one type. A program cannot use the same topic name with two types.")
    if "callback should be either be callable" in text:
        return callback_called(scene) or _no_message(scene)
    if (given := INNER_TYPE.search(text)) is not None:
        text = f"Pass the type {given['type']} itself, not {given['type']}.{given['inner']}."
        return Cause("service-type", text)
    if "timer period must be non-negative" in text:
        made = next(iter(scene.calls_on_line("create_timer")), None)
        fix = at(scene.at(made), "(-", "(") if made is not None else ()
        text = "The period is a time in seconds, so it cannot be negative."
        return Cause("timer-period-negative", text).fixed_by(fix)
    return None


def _calls_of_init(scene: CrashScene) -> str:
    """Return a sentence about the lines that call rclpy.init, or an empty string if there are fewer than two calls."""
    calls = [node for node in scene.nodes if isinstance(node, ast.Call) and dotted(node.func) == "rclpy.init"]
    lines = [str(line) for line in sorted({call.lineno for call in calls})]
    if len(calls) < 2:
        return ""
    return f" rclpy.init is called {f'on lines {a_list(lines)}' if len(lines) > 1 else f'twice on line {lines[0]}'}."


def _no_message(scene: CrashScene) -> Cause:
    for call in scene.calls_on_line("create_subscription"):
        name = (dotted(call.args[2]) or "").rpartition(".")[2] if len(call.args) > 2 else ""
        for method in (each for each in scene.functions(name) if len(each.args.args) < 2):
            text = f"{name} has no parameter for the message that a subscription passes."
            if (only := [each.arg for each in method.args.args if each.arg != "self"]) and scene.class_around(method):
                text = f"{name} is a method, so its first parameter is self. Write {name}(self, {only[0]})."
            return Cause("callback-parameters", text, scene.at(method))
    return Cause("not-callable", "The callback of a subscription is a function or method that takes the message.")
