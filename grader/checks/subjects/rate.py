"""Check of the rate at which commands arrive at the turtle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_ended import why_ended
from grader.checks.causes.why_period import why_mean, why_slow_timer
from grader.checks.causes.why_rate import (
    late_cause,
    why_often,
    why_publishers_grow,
    why_timers_grow,
)
from grader.checks.causes.why_sleep import why_rate_in_callback
from grader.checks.causes.why_stopped import CANCELS, cancelled, stopped_by_exit, why_stopped
from grader.checks.kind import Kind, number
from grader.checks.outcome import Finding, Status, failed, passed
from grader.checks.requested import Interval, Requested
from grader.checks.tolerance import Band
from grader.common.words import count
from grader.common.words import number as shown
from grader.evidence import activity
from grader.turtlesim.turtle import FRAME_S

if TYPE_CHECKING:
    from grader.evidence.arrivals import Measured
    from grader.evidence.evidence import Evidence

FEWEST = 3
"""With fewer commands there is at most one interval, which is not enough for a rate."""
TRUSTED = 0.5
"""If the machine stalled during a trial in wall time, only the intervals without a stall are judged. These must be at
least this fraction of all intervals."""
POSES_HZ = 1.0 / FRAME_S
"""The rate at which turtlesim publishes poses: one pose per frame."""

FASTEST_HZ = 40.0
"""The highest rate (Hz) that can be measured in simulated time, which advances in steps of 16 ms.

A higher rate can be measured if the node sends one message per pose.
"""


@dataclass(frozen=True, kw_only=True)
class Rate:
    """The mean rate from the first to the last arrival, the tolerance of this rate, and the limits of every interval.

    The first command may arrive up to `first_within_s` after the start, and the last command up to `max_interval_s`
    before the end.
    """

    rate_hz: float = number(above=0, at_most=1000, about="The mean rate, from the first to the last arrival.")
    tolerance_percent: float = number(5.0, above=0, at_most=100, about="The maximum error in the mean rate.")
    min_interval_s: float = number(at_least=0, about="The shortest allowed interval between two arrivals.")
    max_interval_s: float = number(
        above=0, about="The longest allowed interval between two arrivals, and from the last arrival to the end."
    )
    first_within_s: float = number(3.0, above=0, about="The maximum time from the start to the first arrival.")


@dataclass(frozen=True)
class Subject:
    """Messages or log lines that arrive: the noun for them, and the method that sends them."""

    noun: str
    call: str

    @property
    def plural(self) -> str:
        """The noun in the plural and with a capital letter, for the beginning of a sentence."""
        return f"{self.noun.capitalize()}s"


COMMAND = Subject("command", "publish")


def rate(evidence: Evidence, params: Rate) -> Finding:
    """The commands arrive at the required rate, on average and in each interval, from the start until the end."""
    return rate_of(evidence, params, COMMAND, evidence.command_arrivals)


def rate_of(evidence: Evidence, params: Rate, what: Subject, measured: Measured) -> Finding:
    """Commands or log lines arrive at the required rate: on average and in each interval, until the end."""
    period = 1.0 / params.rate_hz
    expected = f"One {what.noun} every {period:.2f} s ({shown(params.rate_hz)} Hz)."
    if len(measured.arrivals) < FEWEST:
        return _few(evidence, params, what, measured, f"{expected[:-1]} until Ctrl-C.")
    if measured.trusted < TRUSTED:
        return Finding(
            Status.ERROR,
            "The machine was too busy to measure a rate in wall time. Try again when the machine is less busy.",
        )
    share = params.tolerance_percent / 100.0
    mean_hz = 1.0 / measured.mean_s if measured.mean_s > 0.0 else float("inf")
    mean = Band.around(params.rate_hz, params.rate_hz * share)
    each = Band.around(period, period - params.min_interval_s, params.max_interval_s - period)
    first = Band.at_most(params.first_within_s)
    near = mean.near(mean_hz) or each.near(*_extremes(measured), measured.rest_s) or first.near(measured.first_s)
    near |= mean_hz > FASTEST_HZ and evidence.recording.clock == "simulated" and not _follows_poses(evidence, mean_hz)
    if not mean.holds(mean_hz):
        return _wrong_mean(evidence, what, measured, params, expected, near_edge=near)
    outside = [interval for interval in measured.intervals if not each.holds(interval)]
    if outside:
        worst = max(outside, key=lambda interval: abs(interval - period))
        at = measured.begins[measured.intervals.index(worst)]
        observed = (
            f"{what.plural} arrived at uneven intervals: {worst:.2f} s passed between two of them, "
            f"{at:.1f} s after the start."
        )
        wanted = (
            f"{what.plural} arrive every {period:.2f} s, and each interval is between {params.min_interval_s:.2f} and "
            f"{params.max_interval_s:.2f} s."
        )
        cause = _uneven_cause(evidence, what)
        grow = why_timers_grow(evidence) or why_publishers_grow(evidence)
        if grow is not None:
            return failed(observed, wanted, grow, near_edge=near)
        return failed(observed, wanted, Cause("uneven-rate", cause, evidence.place(what.call)), near_edge=near)
    if not first.holds(measured.first_s):
        observed = f"The first {what.noun} arrived {measured.first_s:.1f} s after the start."
        wanted = f"The first {what.noun} arrives within {params.first_within_s:.1f} s."
        return failed(
            observed,
            wanted,
            Cause("late-start", late_cause(evidence), evidence.place("sleep", what.call)),
            near_edge=near,
        )
    if not measured.rest_s <= params.max_interval_s:
        return _stopped(evidence, what, measured, params, expected, near_edge=near)
    return passed(f"{what.plural} arrive every {period:.2f} s ({shown(params.rate_hz)} Hz).", near_edge=near)


def _follows_poses(evidence: Evidence, mean_hz: float) -> bool:
    """Return whether the node seems to send one message per pose. Its rate is then the same with both clocks."""
    return abs(mean_hz - POSES_HZ) <= 0.5 and not evidence.code.calls("create_timer")


def _extremes(measured: Measured) -> tuple[float, float]:
    return min(measured.intervals), max(measured.intervals)


def _few(evidence: Evidence, params: Rate, what: Subject, measured: Measured, expected: str) -> Finding:
    amount = len(measured.arrivals)
    crash = crash_of(evidence)
    observed = f"{count(amount, what.noun)} arrived in {activity.end_s(evidence.recording):.0f} s."
    if crash is not None:
        return crash_finding(evidence, crash, f"{observed} {end_observed(evidence)}", expected)
    where = evidence.place(what.call)
    ended = None
    if evidence.recording.end.by == "itself":
        ended = failed(f"{observed} {end_observed(evidence)}", expected, why_ended(evidence))
    if ended is not None and (amount == 0 or stopped_by_exit(evidence, measured.arrivals[-1], 1.0 / params.rate_hz)):
        return ended
    slow = why_slow_timer(evidence, what.call, params.rate_hz, amount)
    if slow is not None:
        return failed(observed, expected, slow)
    asleep = why_rate_in_callback(evidence)
    if asleep is not None:
        return failed(observed, expected, asleep)
    if ended is not None and not (amount == 1 and cancelled(evidence, what.call)):
        return ended
    if amount == 1:
        cause = f"A timer calls a method repeatedly, so that {what.call} is called more than once."
        stop = cancelled(evidence, what.call)
        why = Cause("published-once" if what is COMMAND else "logged-once", CANCELS if stop else cause, stop)
        return failed(observed, expected, why.at(where))
    why = Cause("too-few-commands" if what is COMMAND else "too-few-log-lines", where=where)
    return failed(observed, expected, why)


def _wrong_mean(
    evidence: Evidence, what: Subject, measured: Measured, params: Rate, expected: str, *, near_edge: bool
) -> Finding:
    mean = measured.mean_s
    often = (
        why_often(evidence, what.call, mean, 1.0 / params.rate_hz)
        or why_timers_grow(evidence)
        or why_publishers_grow(evidence)
    )
    if mean < 0.01:
        observed = f"{count(len(measured.arrivals), what.noun)} arrived, one every {1000.0 * mean:.2f} ms."
    else:
        observed = f"{what.plural} arrived every {mean:.2f} s ({1.0 / mean:.1f} Hz)."
    if often is not None:
        return failed(observed, expected, often, near_edge=near_edge)
    return failed(
        observed, expected, why_mean(evidence, what.noun, what.call, mean, params.rate_hz), near_edge=near_edge
    )


def _uneven_cause(evidence: Evidence, what: Subject) -> str:
    code = evidence.code
    if len(code.calls(what.call)) > 1 or len(code.calls("create_timer")) > 1:
        return f"More than one line calls {what.call}, or more than one timer runs."
    return f"Does the method that calls {what.call} sleep for longer than the period?" if code.calls("sleep") else ""


def _stopped(
    evidence: Evidence, what: Subject, measured: Measured, params: Rate, expected: str, *, near_edge: bool
) -> Finding:
    observed = f"The last {what.noun} arrived at {measured.arrivals[-1]:.1f} s, {measured.rest_s:.1f} s before the end."
    wanted = f"{expected[:-1]}, until Ctrl-C."
    cause, where = why_stopped(evidence, what.call)
    exited = stopped_by_exit(evidence, measured.arrivals[-1], 1.0 / params.rate_hz)
    crash = crash_of(evidence) if exited or not cause else None
    if crash is not None:
        return crash_finding(evidence, crash, f"{observed} {end_observed(evidence)}", wanted)
    if exited:
        observed = f"{observed} {end_observed(evidence)}"
        why = why_ended(evidence)
        cause, where = why.text, why.where
    why = Cause("stopped-early", cause, where or evidence.place(what.call))
    return failed(observed, wanted, why, near_edge=near_edge)


def requested_rate(_: Evidence, params: Rate) -> Requested:
    """Return the required interval between two commands."""
    return Requested(interval=Interval(1.0 / params.rate_hz, params.min_interval_s, params.max_interval_s))


RATE = Kind(
    "rate",
    "trial",
    "Commands arrive at the right rate",
    Rate,
    rate,
    about="Commands arrive at the given rate: on average and in each interval, from soon after the start until the "
    "end.",
    drives=True,
    requested=requested_rate,
)
