"""Explain why a student's node crashed, from the exception, the source code around it, and the usual mistakes."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.callback_code import functions_in_callbacks
from grader.checks.causes.comma_for_dot import comma_for_dot
from grader.checks.causes.crash_scene import CrashScene
from grader.checks.causes.refused_calls import why_refused
from grader.checks.causes.trailing_comma import trailing_comma
from grader.checks.causes.waiting import SPINS, waits_in_callbacks
from grader.checks.causes.why_attributes import why_no_attribute
from grader.checks.causes.why_calls import why_type
from grader.checks.causes.why_ended import named_only, spins_in_a_thread
from grader.checks.causes.why_fields import why_field
from grader.checks.causes.why_imports import why_no_import
from grader.checks.causes.why_interface import why_interface
from grader.checks.causes.why_main import why_main
from grader.checks.causes.why_names import why_no_name
from grader.checks.causes.why_no_file import why_no_file
from grader.checks.causes.why_none import why_none
from grader.checks.causes.why_parameter_calls import why_parameter_call
from grader.checks.causes.why_passed import why_passed
from grader.checks.causes.why_rate import callbacks_of
from grader.checks.causes.why_rclpy_refused import why_rclpy_refused
from grader.checks.causes.why_response import why_response
from grader.checks.causes.why_segmentation_fault import why_segmentation_fault
from grader.checks.causes.why_transition import why_no_transition
from grader.checks.causes.why_unbound import why_unbound
from grader.checks.causes.why_wrong_object import why_wrong_object
from grader.checks.outcome import Finding, failed
from grader.common.words import a_list, shorten

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.checks.causes.crash import Crash
    from grader.checks.diagnosis import Diagnosis
    from grader.evidence.evidence import Evidence


def _always(diagnosis: Diagnosis) -> Callable[[CrashScene], Cause]:
    return lambda scene: Cause(diagnosis, scene.crash.meaning)


TOPIC_RULES = {
    "must not end with": "A topic name must not end with a slash.",
    "repeated": "A topic name must not have two slashes in a row.",
    "start with a number": "No part of a topic name may begin with a digit.",
    "must not be empty": "A topic name must not be empty.",
}
"""Maps a part of rclpy's message about a topic name to the rule that the name breaks."""


def _why_no_topic(scene: CrashScene) -> Cause:
    rules = (rule for words, rule in TOPIC_RULES.items() if words in scene.crash.message)
    text, given = next(rules, scene.crash.meaning), _topic_given(scene)
    if given is None:
        return Cause("topic-name-invalid", text)
    name, line = given
    space = ", with a space" if " " in name else ""
    return Cause("topic-name-invalid", f'{text} The name here is "{shorten(name)}"{space}.', scene.at(line))


def _topic_given(scene: CrashScene) -> tuple[str, int] | None:
    """Return the name of a topic, service or action in a call on the line of the crash, with its line, or None."""
    for maker in ("create_publisher", "create_subscription", "create_client", "create_service", "ActionClient"):
        for call in scene.calls_on_line(maker):
            for given in (*call.args, *(keyword.value for keyword in call.keywords)):
                if isinstance(given, ast.Constant) and isinstance(given.value, str):
                    return given.value, given.lineno
    return None


def _why_no_init(scene: CrashScene) -> Cause:
    never = "rclpy.init is never called. Call it before you create the node."
    text = scene.crash.meaning if scene.evidence.code.calls("init") else never
    return named_only(scene.evidence, "rclpy.init") or Cause("no-init", text)


def _why_undeclared(scene: CrashScene) -> Cause:
    for call in scene.calls_on_line("get_parameters"):
        if call.args and isinstance(call.args[0], ast.Constant):
            text = "get_parameters takes a list of names. To read one parameter, use get_parameter."
            return Cause("parameter-undeclared", text)
    calls = scene.evidence.code.calls("declare_parameter")
    names = [
        call.node.args[0].value for call in calls if call.node.args and isinstance(call.node.args[0], ast.Constant)
    ]
    declared = f" The node declares {a_list([shorten(str(name)) for name in names])}." if names else ""
    return Cause("parameter-undeclared", f"{scene.crash.meaning}{declared}")


def _why_value(scene: CrashScene) -> Cause | None:
    if any(isinstance(node, ast.Raise) for node in scene.on_line):
        text = "This line raises the exception itself. An exception that nothing catches ends the program."
        around = scene.function.name if scene.function is not None else ""
        if any(name == around for _, name in callbacks_of(scene.evidence, "add_on_set_parameters_callback")):
            text = "To refuse a value, do not raise an exception. Return a SetParametersResult with successful=False."
        return Cause("own-exception", text)
    if "to unpack" in scene.crash.message:
        text = "The number of names differs from the number of values that are unpacked."
        return comma_for_dot(scene) or Cause("crash", text)
    if "history depth" in scene.crash.message:
        return Cause("queue-size", "The queue size is a whole number, and cannot be negative.")
    if "list.remove(x): x not in list" in scene.crash.message:
        return Cause("crash", "remove needs an item that is equal to one in the list, and the list has no such item.")
    if "empty" not in scene.crash.message or not any(name in scene.crash.message for name in ("min()", "max()")):
        return None
    return Cause("no-values", "min or max got no values to compare. Check first whether there are any values.")


ARGUMENTS = re.compile(r"error: the following arguments are required: (?P<names>.+)")
"""Matches the message with which argparse ends the program if a required argument is missing."""


def _why_exit(scene: CrashScene) -> Cause | None:
    """Return the cause if the code calls exit with the number of this exit code, else None."""
    for name in ("exit", "_exit"):
        for call in scene.evidence.code.calls(name):
            given = call.argument(0, "status")
            if isinstance(given, ast.Constant) and f"exit code {given.value!r}" == scene.crash.error:
                return Cause("crash", "This call of exit ends the program with this exit code.", call.where)
    return None


def _why_usage(scene: CrashScene) -> Cause | None:
    """Return the cause if argparse ended the program because a required argument was missing, else None."""
    required = ARGUMENTS.search(scene.evidence.recording.stderr.text)
    if required is None:
        return None
    several = "," in required["names"]
    text = (
        f"The program needs the {'arguments' if several else 'argument'} {shorten(required['names'], 60)}, but the "
        f"grader starts it without arguments. Give {'each' if several else 'the'} argument a default value."
    )
    return Cause("crash", text, scene.evidence.place("parse_args", "parse_known_args"))


def _why_resized(scene: CrashScene) -> Cause | None:
    """Return the cause if the size of a dictionary, set or deque changed during a loop over it, else None."""
    if "during iteration" not in scene.crash.message:
        return None
    text = "An item was added or removed while a loop went through the collection. Loop over a copy: list() makes one."
    return Cause("changed-in-a-loop", text)


def _why_no_loop(scene: CrashScene) -> Cause | None:
    """Return the cause if a callback, or a function that it calls, needs the event loop of asyncio, else None."""
    callbacks = functions_in_callbacks(scene.evidence.code.modules)
    if "no running event loop" not in scene.crash.message or scene.function not in [each for _, each in callbacks]:
        return None
    text = "rclpy calls this callback without the event loop of asyncio. To wait, use a timer instead of asyncio."
    return Cause("asyncio-in-callback", text)


def _why_spinning(scene: CrashScene) -> Cause | None:
    """Return the cause if rclpy refused to spin, because another call spins the same nodes already, else None."""
    if "already spinning" not in scene.crash.message:
        return None
    for wait in waits_in_callbacks(scene.evidence):
        if wait.name in SPINS and wait.where == scene.crash.where:
            return wait.refused_cause
    text = "Another call spins the nodes already, for example in a thread, and rclpy does not spin twice at once."
    return Cause("crash", f"{text} Spin in one place only, usually in main.")


def _why_await(scene: CrashScene) -> Cause | None:
    """Return the cause if a function that is not `async` contains await, else None."""
    if "'await' outside async function" not in scene.crash.message:
        return None
    text = (
        "await is allowed only in a function that begins with async def. Instead of waiting, pass the next step to "
        "add_done_callback."
    )
    return Cause("syntax-error", text)


def _why_zero(scene: CrashScene) -> Cause | None:
    """Return the cause if the node reads integer_value, which is 0 for a parameter that is a float, else None."""
    for node in scene.nodes:
        if isinstance(node, ast.Attribute) and node.attr == "integer_value":
            text = "integer_value is 0 if the parameter is a float. The number is then in double_value."
            return Cause("parameter-itself", text, scene.at(node))
    return None


EXPLANATIONS: dict[str, Callable[[CrashScene], Cause | None]] = {
    "AssertionError": why_field,
    "AttributeError": why_no_attribute,
    "EOFError": _always("needs-stdin"),
    "ImportError": why_no_import,
    "FileNotFoundError": why_no_file,
    "InvalidNodeNameException": _always("node-name-invalid"),
    "InvalidServiceNameException": _why_no_topic,
    "InvalidTopicNameException": _why_no_topic,
    "ModuleNotFoundError": why_no_import,
    "NameError": why_no_name,
    "NotInitializedException": _why_no_init,
    "ParameterNotDeclaredException": _why_undeclared,
    "RCLError": lambda scene: why_no_transition(scene) or why_refused(scene),
    "RuntimeError": lambda scene: (
        _why_resized(scene) or _why_no_loop(scene) or _why_spinning(scene) or why_refused(scene)
    ),
    "SIGABRT": lambda scene: spins_in_a_thread(scene.evidence),  # ROS 2 may abort if the main thread ends first
    "SIGSEGV": why_segmentation_fault,
    "SyntaxError": _why_await,
    "TypeError": lambda scene: why_none(scene) or why_type(scene),
    "UnboundLocalError": why_unbound,
    "exit code 2": _why_usage,
    "ValueError": _why_value,
    "ZeroDivisionError": _why_zero,
}
"""Maps the `error` of a crash to a function that returns the cause, or None if the source does not show the cause."""


def why_crashed(evidence: Evidence, crash: Crash) -> Cause:
    """Return the cause of the crash, with an explanation.

    If the source code does not show the cause, explain only the exception.
    """
    explain = EXPLANATIONS.get(crash.error)
    scene = CrashScene(evidence, crash)
    special = trailing_comma(scene) or why_main(scene) or why_response(scene) or why_interface(scene)
    special = (
        special or why_parameter_call(scene) or why_rclpy_refused(scene) or why_wrong_object(scene) or why_passed(scene)
    )
    cause = special or (explain(scene) if explain is not None else None) or _why_exit(scene)
    return cause or Cause("crash", crash.meaning)


def crash_finding(evidence: Evidence, crash: Crash, observed: str, expected: str) -> Finding:
    """Return a failed finding for a check that did not pass because of a crash."""
    cause = why_crashed(evidence, crash)
    return failed(observed, expected, cause.at(crash.where or evidence.place("init")))
