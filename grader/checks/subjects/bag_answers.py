"""Checks of answers about the student's own bag. Each answer is a number, with its unit if it has one."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.kind import Kind, choice, number, string
from grader.checks.outcome import Finding, failed, passed
from grader.checks.subjects.answers import KEY, shown_answer
from grader.checks.subjects.recorded_bag import BAG
from grader.checks.tolerance import Band
from grader.common.lazy import np
from grader.common.words import shorten
from grader.evidence.circle_fit import fit_circle
from grader.submission.answers_toml import FILE
from grader.submission.bag_folder import Poses
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

NUMBER = re.compile(r"(?P<number>[-+]?\d{1,19}(?:\.\d{1,15})?(?:[eE][-+]?\d{1,2})?)\s*(?P<unit>[A-Za-z/%]*)", re.ASCII)
EXAMPLE = {"messages": '"1250"', "duration": '"12.5 s"', "rate": '"10.0 Hz"', "radius": '"1.00 m"'}
ROUNDED = 0.02
"""The maximum relative error that rounding may cause, in an answer or in its inverse."""
HUNDREDTH = 0.0101
UNITS = {"messages": "", "duration": "s", "rate": "Hz", "radius": "m"}


@dataclass(frozen=True, kw_only=True)
class BagAnswer:
    """A quantity that the student reads or calculates from the bag."""

    answer: str = string(KEY, about="The name of the answer in answers.toml.")
    bag: str = string("the name of a folder", about=BAG)
    topic: str = string("a topic", start="/", default="/turtle1/pose", about="The topic with the poses.")
    quantity: str = choice(
        "messages",
        "duration",
        "rate",
        "radius",
        about="The quantity: the number of messages on the topic, the time (s) from the first message to the last one, "
        "the rate (Hz) of the messages, or the radius (m) of the circle on which the poses lie.",
    )
    tolerance_percent: float = number(
        2.0,
        at_least=0,
        at_most=100,
        about="The maximum error in the answer. A value with a unit may also be rounded to two decimal places.",
    )


def bag_answer(evidence: Evidence, params: BagAnswer) -> Finding:
    """The answer matches the bag, and has the right unit."""
    found = evidence.answers
    where = Where(FILE, found.lines.get(params.answer) if found is not None else None)
    given = found.given.get(params.answer) if found is not None else None
    unit = UNITS[params.quantity]
    expected = (
        f"{params.answer} is a number{f' and its unit, {unit}' if unit else ''}, as in {EXAMPLE[params.quantity]}."
    )
    if given is None and found is not None and params.answer in found.unusable:
        return failed(f"{params.answer} is neither a string nor a number.", expected, Cause("answer-form", where=where))
    if given is None:
        return failed(f"{params.answer} is not answered yet.", expected, Cause("no-answer", where=where))
    match = NUMBER.fullmatch(f"{given:.0f}" if isinstance(given, float) and not unit else str(given).strip())
    if match is None:
        written = shown_answer(given) if isinstance(given, tuple) else shorten(str(given))
        comma = "Write a dot, not a comma, in decimal numbers." if unit else "Write the number without a comma."
        comma = comma if re.match(r"\s*\d+,\d", str(given)) else ""
        return failed(f"{params.answer} is {written}.", expected, Cause("answer-form", comma, where))
    value, has = float(match["number"]), match["unit"]
    observed = f"{params.answer} is {shorten(match[0])}."
    if has != unit:
        if not has:
            cause = "A number needs its unit."
            return failed(observed, expected, Cause("unit-missing", cause, where))
        cause = f"The unit is {unit}." if unit else "A count has no unit."
        return failed(observed, expected, Cause("wrong-unit", cause, where))
    truth = _truth(evidence, params)
    band = Band.around(truth, truth * params.tolerance_percent / 100.0 + 0.005 * bool(unit))
    if band.holds(value):
        return passed(f"{shorten(match[0])} is right.")
    total = sum(evidence.bag(params.bag).counts.values())
    if params.quantity == "messages" and value == total:
        counts = Cause("all-messages", "Only the messages on the topic with the poses count.", where)
        return failed(observed, "The answer is the value in your bag.", counts)
    count = len(evidence.bag(params.bag).poses.get(params.topic, Poses()).t_s)
    why = _why(params.quantity, value, truth, count)
    return failed(observed, "The answer is the value in your bag.", why.at(where))


def _truth(evidence: Evidence, params: BagAnswer) -> float:
    poses = evidence.bag(params.bag).poses.get(params.topic, Poses())
    if params.quantity == "messages":
        return len(poses.t_s)
    if params.quantity == "radius":
        circle = fit_circle(np.array(poses.x), np.array(poses.y))
        return circle.radius if circle is not None else 0.0
    duration_s = poses.t_s[-1] - poses.t_s[0] if poses.t_s else 0.0
    if params.quantity == "duration":
        return duration_s
    return (len(poses.t_s) - 1) / duration_s if duration_s else 0.0


def _why(quantity: str, value: float, truth: float, count: int) -> Cause:
    band = Band.around(truth, truth * ROUNDED)
    if any(band.holds(value * factor) for factor in (1e-9, 1e9)):
        return Cause("nanoseconds", "Time stamps in a bag are in nanoseconds. A second has 1,000,000,000 nanoseconds.")
    if quantity == "rate" and value and band.holds(1.0 / value):
        cause = "This is the period, the time between two messages in seconds. The rate is 1 divided by the period."
        return Cause("period-for-rate", cause)
    if quantity == "rate" and count and abs(value * (count - 1) / count - truth) <= HUNDREDTH:
        cause = "This is the number of messages divided by the duration. n messages have only n - 1 intervals."
        return Cause("rate-off-by-one", cause)
    if quantity == "radius" and band.holds(value / 2.0):
        return Cause("diameter", "This is the diameter, twice the radius.")
    if quantity == "duration":
        cause = "`ros2 bag info` shows the duration of a bag. Does the answer come from an earlier bag?"
        return Cause("wrong-answer", cause)
    cause = (
        "If your own program prints this value for this bag, the program is wrong. "
        "Otherwise, the answer may come from an earlier bag."
    )
    return Cause("wrong-answer", cause)


ANSWER = Kind(
    "bag_answer",
    "source",
    "The answer matches the bag",
    BagAnswer,
    bag_answer,
    about="A value in `answers.toml`, with its unit if it has one, matches the student's bag.",
)
