"""Check of logged feedback: while the turtle follows a goal, log lines show the remaining angle."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.log_place import log_place
from grader.checks.causes.why_blocked import why_blocked
from grader.checks.kind import Kind, number, string
from grader.checks.outcome import Finding, failed, passed
from grader.checks.subjects.goals import goals_of, no_goal
from grader.checks.subjects.log import LogFormat, lines_in
from grader.checks.tolerance import Band
from grader.common.lazy import np
from grader.common.words import count
from grader.evidence import activity, student_log
from grader.turtlesim.turtle import normalize

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.evidence.evidence import Evidence
    from grader.evidence.student_log import Line
    from grader.trial.observed import Goal

BEGIN_S = 0.1
"""The time (s) after the acceptance of a new goal during which a log line may still be about the previous goal."""
FRAME_S = 0.016
LONG = 2.0
"""A goal counts if it lasts at least this many periods. A goal that lasts for a shorter time can end between two log
lines."""
SLOWEST = Band.at_most(1.5)
"""The maximum median time between two lines during a goal, in periods."""


@dataclass(frozen=True, kw_only=True)
class LogFeedback:
    """While a goal is active, the node logs a line every `period_s` seconds.

    The angle in the line is at most `lag_s` old.
    """

    format: str = string(
        "a log line that contains {remaining}", about="The format of a line with the number `remaining`."
    )
    period_s: float = number(0.5, above=0, about="The time between two lines.")
    tolerance_rad: float = number(0.05, above=0, about="The maximum error in the angle.")
    lag_s: float = number(0.15, above=0, about="The maximum age of the angle in a line.")


def log_feedback(evidence: Evidence, params: LogFeedback) -> Finding:
    """While the turtle follows a goal, log lines show the remaining angle."""
    example = student_log.Format(params.format).example(1.25)
    expected = f'While the turtle turns, a line such as "{example}" appears every {params.period_s:g} s.'
    sent = goals_of(evidence)
    if not sent:
        return no_goal(evidence, expected)
    goals = [goal for goal in sent if _ended_s(evidence, goal) - goal.t_s >= LONG * params.period_s]
    if not goals:
        observed = f"No goal lasted {LONG * params.period_s:g} s, so the log lines could not be judged."
        return failed(observed, expected, Cause("feedback-not-logged", "", evidence.place("send_goal_async")))
    lines = student_log.in_format(evidence.recording, params.format)
    told = [
        (line, goal)
        for goal in goals
        for line in lines
        if goal.t_s + BEGIN_S < line.t_s < _ended_s(evidence, goal) and not evidence.recording.stalled(line.t_s)
    ]
    wrong = [pair for pair in told if not _holds(evidence, params, *pair)]
    if not lines:
        return _none_in_format(evidence, params, goals, expected)
    where = log_place(evidence, student_log.Format(params.format).example())
    if wrong:
        return _wrong(evidence, params, told, wrong[0], expected)
    turning_s = sum(_ended_s(evidence, goal) - goal.t_s for goal in goals)
    amount = Band(0.5 * turning_s / params.period_s - 1.0, 2.0 * turning_s / params.period_s + 1.0)
    if not amount.holds(len(told)):
        lines_told = count(len(told), "line")
        observed = f"{lines_told} with the feedback appeared while the turtle turned for {turning_s:.1f} s."
        if len(told) > turning_s / params.period_s:
            text = (
                "The feedback arrives 62.5 times per second. Store the number, and log the stored number in the "
                "callback of a timer."
            )
            return failed(observed, expected, Cause("every-message", text, where))
        text = "Log the number in the callback of a timer while there is a goal."
        return failed(observed, expected, _unheard(evidence) or Cause("feedback-not-logged", text, where))
    stalls = evidence.recording.stalls
    gaps = [
        later.t_s - line.t_s
        for (line, of), (later, next_) in pairwise(told)
        if of is next_ and not any(begin <= later.t_s and end >= line.t_s for begin, end in stalls)
    ]
    middle_s = float(np.median(gaps)) if gaps else params.period_s
    if not SLOWEST.holds(middle_s / params.period_s):
        observed = f"While the turtle turns, a line appears every {middle_s:.2g} s."
        text = "The period of the timer whose callback logs the line is too long."
        cause = Cause("timer-period", text, evidence.place("create_timer"))
        return failed(observed, expected, cause, near_edge=SLOWEST.near(middle_s / params.period_s))
    near = SLOWEST.near(middle_s / params.period_s)
    return passed("The lines show how far the turtle still has to turn.", near_edge=near)


def _unheard(evidence: Evidence) -> Cause | None:
    """Return the cause if every goal is sent without a feedback callback, else None."""
    sends = evidence.code.calls("send_goal_async")
    if not sends or any(call.argument(1, "feedback_callback") is not None for call in sends):
        return None
    text = "Nothing in the node receives the feedback. send_goal_async has an argument feedback_callback."
    return Cause("feedback-not-logged", text, sends[0].where)


def _none_in_format(evidence: Evidence, params: LogFeedback, goals: list[Goal], expected: str) -> Finding:
    """Return the failed finding about a log without lines in the required format.

    Only lines logged during a goal count.
    """
    recording = evidence.recording
    during = tuple(
        line for line in recording.log if any(goal.t_s < line.t_s < _ended_s(evidence, goal) for goal in goals)
    )
    seen = evidence.with_run(replace(evidence.run, recording=replace(recording, log=during)))
    logged = student_log.students(seen.recording)
    cause = _unheard(evidence) or (None if logged else why_blocked(evidence))
    if cause is not None:
        return failed("The log has no line with the feedback.", expected, cause)
    return lines_in(seen, LogFormat(format=params.format), " during the goals")


def _ended_s(evidence: Evidence, goal: Goal) -> float:
    return activity.end_s(evidence.recording) if goal.ended_s is None else goal.ended_s


def _near(evidence: Evidence, params: LogFeedback, line: Line, matches: Callable[[float, float], bool]) -> bool:
    """Return whether `matches` returns True for the time and heading of a frame that the log line can describe."""
    frames = evidence.recording.frames
    near = (frames.t_s >= line.t_s - params.lag_s) & (frames.t_s <= line.t_s + FRAME_S)
    pairs = zip(frames.t_s[near].tolist(), frames.theta[near].tolist(), strict=True)
    return any(matches(t_s, theta) for t_s, theta in pairs)


def _holds(
    evidence: Evidence, params: LogFeedback, line: Line, goal: Goal, *, factor: float = 1.0, signed: bool = True
) -> bool:
    def matches(_: float, theta: float) -> bool:
        remaining = normalize(normalize(goal.request["theta"]) - theta)
        logged = line.numbers["remaining"] / factor
        return abs(logged - (remaining if signed else abs(remaining))) <= params.tolerance_rad

    return _near(evidence, params, line, matches)


def _wrong(
    evidence: Evidence,
    params: LogFeedback,
    told: list[tuple[Line, Goal]],
    worst: tuple[Line, Goal],
    expected: str,
) -> Finding:
    line, goal = worst
    frames = evidence.recording.frames
    theta = float(frames.theta[max(int(np.searchsorted(frames.t_s, line.t_s)) - 1, 0)])
    remaining = normalize(normalize(goal.request["theta"]) - theta)
    observed = (
        f"At {line.t_s:.1f} s, the line shows {line.numbers['remaining']:.2f}, "
        f"but the turtle still had to turn by {remaining:.2f} rad."
    )
    where = log_place(evidence, student_log.Format(params.format).example())
    if all(_holds(evidence, params, *pair, factor=-1.0) for pair in told):
        return failed(observed, expected, Cause("wrong-sign", "Log the number from the feedback unchanged.", where))
    if all(_holds(evidence, params, *pair, signed=False) for pair in told):
        text = "The number keeps its sign: it is negative while the turtle turns to the right. Do not use abs."
        return failed(observed, expected, Cause("wrong-sign", text, where))
    if all(_holds(evidence, params, *pair, factor=math.degrees(1.0)) for pair in told):
        text = "The feedback is in radians, and the line must be in radians too."
        return failed(observed, expected, Cause("degrees", text, where))
    if len(told) > 1 and len({line.numbers["remaining"] for line, _ in told}) == 1:
        text = "The number never changes. Store the number in self each time feedback arrives."
        return failed(observed, expected, Cause("stale-feedback", text, where))
    text = "The message has a field feedback, which has the field remaining."
    return failed(observed, expected, Cause("wrong-feedback", text, where))


LOG_FEEDBACK = Kind(
    "log_feedback",
    "trial",
    "The log shows the feedback",
    LogFeedback,
    log_feedback,
    about="While a rotate_absolute goal is active, log lines show how far the turtle must still turn.",
)
