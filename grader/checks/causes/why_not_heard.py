"""Explain from the events in the node under test why a student's test has not received enough messages."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.waiting import SPINS
from grader.checks.causes.why_rejected import place_of
from grader.common.words import count
from grader.submission.uses import uses_of
from grader.testbench.result import LATEST_S

if TYPE_CHECKING:
    from grader.exercise.node_under_test import Behaviour
    from grader.submission.pytest_files import TestCode
    from grader.submission.uses import Use
    from grader.submission.where import Where
    from grader.testbench.result import NodeEvents, NodeRun

NOTHING_RECEIVED = re.compile(
    r"IndexError: (?:list|deque|tuple) index out of range|IndexError: pop from (?:an )?empty|len\(\[\]\)|assert \[\]|"
    r"'NoneType' object has no attribute '(?:linear|angular)'|is an empty sequence|iterable argument is empty"
)
"""Matches pytest's messages about a test that reads a command although the test has received none."""
COUNTED = re.compile(r"assert (?P<received>\d{1,6}) (?:==|>=|>) (?P<wanted>\d{1,6})\n +\+  where \d+ = len\(\[")
"""Matches pytest's message about an assert that compares the number of received messages with another number."""


def why_not_heard(run: NodeRun, code: TestCode, right: Behaviour) -> Cause | None:
    """Return the reason why a test has not received enough commands from the correct node, or None."""
    events = run.events
    if run.over or events is None:
        return None
    if _moves_the_wrong_clock(events, code):
        return Cause("bench-wall-time", WALL_TIME, _place(code, run, OVERRIDE))
    if not NOTHING_RECEIVED.search(run.message):
        return _too_few(events, run, code, right)
    if not events.calls:
        return _not_called(events, run, code, right)
    if not events.poses:
        text = (
            f"The callback of the node's timer ran {count(events.calls, 'time')}, but no pose had arrived on "
            f"{right.listens}. Does the bench publish a Pose on this topic, and does it spin after that?"
        )
        return Cause("bench-no-pose", text, _place(code, run, "create_publisher"))
    if not events.commands:
        return Cause("bench-clock-stands", LATE, _place(code, run, OVERRIDE))
    text = (
        f"The node has published {count(events.commands, 'command')} on {right.topic}, but the test has received none. "
        "Is the subscribing node in the executor, is its topic right, and does the bench spin often enough?"
    )
    return Cause("bench-not-heard", text, _place(code, run, "create_subscription"))


def _too_few(events: NodeEvents, run: NodeRun, code: TestCode, right: Behaviour) -> Cause | None:
    """Return the reason why a test has received too few commands, or None if the timer's calls do not show it."""
    counted = COUNTED.match(run.message)
    if counted is None or int(counted["received"]) >= int(counted["wanted"]):
        return None
    if events.first_s is None or events.clock_s is None or not events.calls:
        return None
    if events.first_s == 0.0 and int(counted["received"]) == int(counted["wanted"]) - 1:
        return Cause("bench-clock-not-started", NOT_STARTED, _place(code, run, OVERRIDE))
    due = round((events.clock_s - events.first_s) / right.period_s)
    if events.calls >= due - 1:
        return None
    # The message has no measured numbers, because they differ from run to run.
    text = (
        f"On the node's clock, the timer's callback ran less than once per period ({right.period_s:g} s). "
        "Each call to spin_once runs at most one callback. If one step of the clock is longer than the timer's "
        "period, some calls are lost."
    )
    return Cause("bench-loses-calls", text, _place(code, run, "spin_once"))


def why_not_called(run: NodeRun | None, code: TestCode, right: Behaviour) -> Cause | None:
    """Return the reason why no timer callback was called in any test of a run.

    Return None if one was called, or if nothing is known about the run.
    """
    if run is None or run.events is None or run.events.all_calls:
        return None
    if _moves_the_wrong_clock(run.events, code):
        return Cause("bench-wall-time", WALL_TIME, _place(code, run, OVERRIDE))
    return _not_called(run.events, run, code, right)


def _moves_the_wrong_clock(events: NodeEvents, code: TestCode) -> bool:
    """Return whether the tests set a clock, although the node's clock follows the system time."""
    return events.clock_s is not None and events.clock_s >= LATEST_S and bool(_uses(code, OVERRIDE))


def _not_called(events: NodeEvents, run: NodeRun, code: TestCode, right: Behaviour) -> Cause:
    """Return the reason why the callback of the timer has never run."""
    if events.clock_s is None and not any(_uses(code, name) for name in SPINS):
        text = "No test spins the node, so no callback of the node runs. Call spin_once in the tests."
        return Cause("bench-not-spun", text, place_of(run, code))
    if events.clock_s is None:
        return Cause("bench-not-spun", NOT_SPUN, _place(code, run, "add_node"))
    if events.clock_s >= LATEST_S:
        text = (
            "A pose arrived, but the callback of the node's timer has not run. The node's clock follows the system "
            f"time. Set its parameter use_sim_time to True, advance the clock in steps of {right.period_s:g} s, and "
            "spin after each step."
        )
        return Cause("bench-clock-stands", text, _place(code, run, OVERRIDE))
    if not events.clock_s and _uses(code, OVERRIDE):
        return Cause("bench-clock-stands", OTHER_CLOCK, _place(code, run, OVERRIDE))
    text = (
        f"A pose arrived when the node's clock showed {events.clock_s:g} s, but the callback of its timer has not run. "
        f"The callback is due after a whole period: advance the clock in steps of {right.period_s:g} s, and spin after "
        "each step."
    )
    return Cause("bench-clock-stands", text, _place(code, run, OVERRIDE))


OVERRIDE = "set_ros_time_override"
OTHER_CLOCK = (
    f"When the last pose arrived, the node's clock showed 0 s, although the tests contain {OVERRIDE}. "
    "Do the tests call this method, and on the clock of the node under test?"
)
NOT_SPUN = (
    "The node has received no pose, and the callback of its timer has not run. Is the node in the executor, and "
    "does the bench call spin_once after each step of the clock?"
)
WALL_TIME = (
    f"The node's clock follows the system time, so {OVERRIDE} does not change it. Set the node's parameter "
    "use_sim_time to True first."
)
NOT_STARTED = (
    "The pose arrived when the node's clock showed 0 s, which counts as not set. The first period of the timer begins "
    "with the first step of the clock. Advance the clock by one step before the tests begin."
)
LATE = "The pose arrived after the last run of the timer's callback. Advance the clock after the pose."


def _place(code: TestCode, run: NodeRun, call: str) -> Where | None:
    """Return the first line of the tests that calls this function, or else the line that failed, or None."""
    uses = _uses(code, call)
    return uses[0].where if uses else place_of(run, code)


def _uses(code: TestCode, call: str) -> list[Use]:
    return [use for module in code.modules for use in uses_of(code.modules, module.file, frozenset({call}))]
