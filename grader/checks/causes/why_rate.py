"""Explain why messages or log lines arrive too often, too rarely or too late, for example because a loop has no pause.

grader.checks.causes.why_period explains wrong periods of timers, and grader.checks.causes.why_sleep explains sleeps.
"""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.each_time import each_time, evaluated
from grader.checks.causes.waiting import SPINS
from grader.common.words import a_list
from grader.submission.constants import dotted, evaluate, number
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Call, Module

OFTEN = 0.5
"""In a loop without a pause, the mean interval is less than this fraction of the expected period."""
WITHOUT_PAUSE = "The period of this timer is 0 s, so it calls its method without a pause."
NO_PAUSE_S = 0.05
"""If the mean interval (s) is longer than this, something in the loop takes time, for example an inner loop that
waits."""
SEVERAL = 0.1
"""Several calls in a function explain a wrong rate if their number differs from the number of messages per period by at
most this fraction."""
PAUSES = ("sleep", "sleep_for", "sleep_until", *SPINS, "wait", "get", "join", "input")
"""Functions and methods whose purpose is to wait."""
FRAME_S = 0.016
"""The duration of a turtlesim frame (s). turtlesim publishes the pose once per frame."""
EACH_FRAME = ("pose", "color_sensor")
"""The last parts of the names of the topics on which turtlesim publishes once per frame."""


def why_often(evidence: Evidence, call: str, mean_s: float, period_s: float) -> Cause | None:
    """Return the cause if a loop or a timer without a pause, or the callback for poses, calls `call`, else None."""
    for module in evidence.code.modules:
        for node in module.nodes:
            where = Where(module.file, getattr(node, "lineno", None))
            busy = isinstance(node, ast.While) and _calls(node, call) and not _pauses(module, node, call)
            if busy and mean_s < min(OFTEN * period_s, NO_PAUSE_S):
                return Cause("loop-without-pause", f"This loop calls {call} without a pause.", where)
    never_waits = period_of_zero(evidence, call)
    if never_waits is not None:
        return Cause("timer-period", WITHOUT_PAUSE, never_waits.where)
    if abs(mean_s - FRAME_S) > 0.1 * FRAME_S or _sets_that_rate(evidence, call, mean_s):
        return None
    for subscription in evidence.code.calls("create_subscription"):
        module, topic = subscription.module, evaluate(subscription.argument(1, "topic"), subscription.module.names)
        if isinstance(topic, str) and topic.rpartition("/")[2] not in EACH_FRAME:
            continue
        for node in called_by(subscription, 2):
            if reaches(module, node, call):
                name = node.name
                text = f"{name} is called for every message, 62.5 times per second, and each time it calls {call}."
                return Cause("every-message", text, Where(module.file, node.lineno))
    return None


def _sets_that_rate(evidence: Evidence, call: str, mean_s: float) -> bool:
    """Return whether a timer or a sleep may be the reason for this mean interval (s)."""
    lengths = [length_of(sleep) for sleep in evidence.code.calls("sleep")]
    lengths += [
        number(timer.argument(0, "timer_period_sec"), timer.module.names)
        for timer in evidence.code.calls("create_timer")
        if may_send(timer, call)
    ]
    return any(length is None or abs(length - mean_s) <= 0.1 * mean_s for length in lengths)


def called_by(maker: Call, place: int) -> list[ast.FunctionDef]:
    """Return the functions in the module that may be the callback, the argument with this index."""
    name = (dotted(maker.argument(place, "callback") or ast.Constant(0)) or "").rpartition(".")[2]
    return named(maker.module, name)


def named(module: Module, name: str) -> list[ast.FunctionDef]:
    """Return the functions of the module with this name."""
    return [each for each in module.nodes if isinstance(each, ast.FunctionDef) and each.name == name]


def may_send(timer: Call, *calls: str) -> bool:
    """Return whether the callback of the timer may call one of these functions. It may if it is not in the module."""
    own = called_by(timer, 1)
    return not own or any(reaches(timer.module, each, *calls) for each in own)


def _pauses(module: Module, loop: ast.While, call: str) -> bool:
    """Return whether a loop waits in some way, or calls `call` only if a condition is true."""
    inner = [each for statement in loop.body for each in ast.walk(statement)]
    waits = reaches(module, loop, *PAUSES) or any(
        isinstance(each, ast.While) and not _calls(each, call) for each in inner
    )
    return waits or not any(_calls(each, call) for each in loop.body if not isinstance(each, ast.If))


def period_of_zero(evidence: Evidence, call: str) -> Call | None:
    """Return the call that creates a timer with the period 0 whose callback may call `call`, or None."""
    for timer in evidence.code.calls("create_timer"):
        if number(timer.argument(0, "timer_period_sec"), timer.module.names) == 0.0 and may_send(timer, call):
            return timer
    return None


def reaches(module: Module, part: ast.AST, *calls: str) -> bool:
    """Return whether a part of the module calls one of these functions, either directly or through its functions."""
    functions = [node for node in module.nodes if isinstance(node, ast.FunctionDef)]
    waiting, seen = [part], {id(part)}
    while waiting:
        node = waiting.pop()
        if _calls(node, *calls):
            return True
        names = {_name(each) for each in ast.walk(node) if isinstance(each, ast.Call)}
        new = [each for each in functions if each.name in names and id(each) not in seen]
        seen |= {id(each) for each in new}
        waiting += new
    return False


def why_publishers_grow(evidence: Evidence) -> Cause | None:
    """Return the cause if a callback creates a publisher, else None."""
    found = made_in_callback(evidence, "create_publisher", always=True)
    if found is None:
        return None
    name, where = found
    text = f"{name} creates a new publisher each time it is called. Create the publisher once, in __init__."
    return Cause("publisher-in-callback", text, where)


def why_timers_grow(evidence: Evidence) -> Cause | None:
    """Return the cause if a callback creates a timer, else None.

    A callback that also stops a timer is not reported, because it may replace its own timer.
    """
    found = made_in_callback(evidence, "create_timer", always=True)
    if found is None:
        return None
    name, where = found
    functions = [node for module in evidence.code.modules for node in module.nodes if isinstance(node, ast.FunctionDef)]
    if any(_calls(node, stop) for node in functions if node.name == name for stop in ("cancel", "destroy_timer")):
        return None
    text = f"{name} creates a new timer each time it is called. One timer is enough, because it repeats."
    return Cause("timer-in-callback", text, where)


def why_several_calls(evidence: Evidence, call: str, mean_s: float, period_s: float) -> Cause | None:
    """Return the cause if a function calls `call` about as often as messages arrive in one period, at least twice."""
    for module in evidence.code.modules:
        for node in module.nodes:
            if isinstance(node, ast.FunctionDef):
                found = [each for each in ast.walk(node) if isinstance(each, ast.Call)]
                found = [each for each in found if getattr(each.func, "attr", "") == call]
                lines = sorted(each.lineno for each in found)
                owners = {ast.unparse(each.func).rpartition(".")[0] for each in found}
                every = len(lines) == _most(node.body, call) and len(owners) == 1
                if len(lines) > 1 and every and abs(period_s / mean_s - len(lines)) <= SEVERAL * len(lines):
                    named = a_list(list(map(str, lines)))
                    text = f"Each time {node.name} runs, it calls {call} {len(lines)} times, on lines {named}."
                    return Cause("wrong-rate", text, Where(module.file, lines[-1]))
    return None


def _most(body: list[ast.stmt], call: str) -> int:
    """Return the maximum number of times that the statements call `call`, if each loop has one iteration.

    Only one branch of an if or match runs. After an if that contains return, continue or break, nothing is counted.
    """
    amount = 0
    for statement in body:
        if isinstance(statement, ast.If):
            amount += max(_most(statement.body, call), _most(statement.orelse, call))
            if any(isinstance(each, ast.Return | ast.Continue | ast.Break) for each in ast.walk(statement)):
                return amount
        elif isinstance(statement, ast.For | ast.While | ast.With | ast.Try):
            amount += sum(_most(getattr(statement, part, []), call) for part in ("body", "orelse", "finalbody"))
        elif isinstance(statement, ast.Match):
            amount += max(_most(case.body, call) for case in statement.cases)
        else:
            calls = (each for each in evaluated(statement) if isinstance(each, ast.Call))
            amount += sum(getattr(each.func, "attr", "") == call for each in calls)
    return amount


def late_cause(evidence: Evidence) -> str:
    """Return a sentence about a possible reason why the first message or line is late, or an empty string."""
    if evidence.code.calls("sleep"):
        return "A sleep at the start may be the reason."
    waits = evidence.code.calls("wait_for_service")
    return "The wait for a service (wait_for_service) may be the reason." if waits else ""


def length_of(sleep: Call) -> float | None:
    """Return the length (s) of a call to sleep, or None if it is not known from the source."""
    return number(sleep.argument(0, "secs"), sleep.module.names)


def made_in_callback(evidence: Evidence, maker: str, *, always: bool = False) -> tuple[str, Where] | None:
    """Return the name of a callback that calls `maker` and the place of the call, or None.

    With `always`, the callback must call `maker` each time. In `if self.timer is None`, it may do so only once.
    """
    for module in evidence.code.modules:
        called = {
            name for each, name in callbacks_of(evidence, "create_timer", "create_subscription") if each is module
        }
        for node in module.nodes:
            if isinstance(node, ast.FunctionDef) and node.name in called:
                for inner in each_time(node.body) if always else ast.walk(node):
                    if isinstance(inner, ast.Call) and _name(inner) == maker:
                        return node.name, Where(module.file, inner.lineno)
    return None


PLACES = {"create_timer": 1, "add_done_callback": 0, "add_on_set_parameters_callback": 0}
"""Maps a function to the index of its callback argument. For functions that are not listed here, the index is 2."""


def callbacks_of(evidence: Evidence, *makers: str) -> Iterator[tuple[Module, str]]:
    """Yield the names of the callbacks passed to `makers` (default: create_subscription), with their modules."""
    for maker in makers or ("create_subscription",):
        for call in evidence.code.calls(maker):
            name = dotted(call.argument(PLACES.get(maker, 2), "callback") or ast.Constant(0))
            if name is not None:
                yield call.module, name.rpartition(".")[2]


def _calls(node: ast.AST, *names: str) -> bool:
    calls = (each for each in ast.walk(node) if isinstance(each, ast.Call))
    return any(_name(call) in names for call in calls)


def _name(call: ast.Call) -> str:
    """Return the name of the called function, without module or object."""
    return getattr(call.func, "attr", getattr(call.func, "id", ""))
