"""Checks of the log, where logging is the task: lines in the lesson's format, at a rate, with a rising counter."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from grader.checks.causes.crash import crash_of, end_seen, ended_early
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_silent import why_nothing, why_qos
from grader.checks.kind import Kind, number, text
from grader.checks.outcome import Finding, failed, passed
from grader.checks.subjects.rate import Rate, Subject, rate_of
from grader.common.words import number as shown
from grader.common.words import shorten
from grader.evidence import lines
from grader.evidence.arrivals import measure_arrivals

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

LOG_LINE = Subject("log line", "info")
FORMAT = "The format of a line, with its numbers in braces, as in `Hello {counter}` or `x={x:.2f}`."
LEVELS = ("info", "warning", "warn", "error", "fatal")


@dataclass(frozen=True, kw_only=True)
class LogFormat:
    """The format of a line, its numbers in braces: "Hello {counter}", "x={x:.2f}"."""

    format: str = text("a line of the log, with its numbers in braces", about=FORMAT)


def log_lines(evidence: Evidence, params: LogFormat) -> Finding:
    """Lines in the format arrive on /rosout."""
    example = lines.Format(params.format).example()
    expected = f'Lines such as "{example}" in the log.'
    if lines.in_format(evidence.recording, params.format):
        return passed(f'The log has lines such as "{example}".')
    crash = crash_of(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, end_seen(evidence), expected)
    said = [line.text for line in lines.students(evidence.recording)]
    qos = why_qos(evidence)
    if qos is not None:
        seen = "No message reached the subscription, and no line came."
        return failed(qos.diagnosis, seen, expected, qos.text, where=qos.where)
    if said:
        return _other_format(evidence, params, said, expected)
    pattern = lines.Format(params.format).pattern()
    if any(pattern.search(line) for line in evidence.recording.stdout.text.splitlines()):
        seen = "The lines are printed, and not logged."
        cause = "print writes to this terminal alone; get_logger().info(...) tells ROS 2 too, with time and node."
        return failed("print-instead", seen, expected, cause, where=evidence.place("print"))
    return _silent(evidence, expected)


def _silent(evidence: Evidence, expected: str) -> Finding:
    seen = f"The node logged nothing. {end_seen(evidence)}".rstrip()
    code = evidence.code
    if not any(code.calls(level) for level in LEVELS):
        cause = "get_logger().info(...) is called nowhere."
        return failed("no-log", seen, expected, cause, where=code.start)
    why = why_nothing(evidence, LEVELS)
    if why is not None:
        return failed(why.diagnosis, seen, expected, why.text, where=why.where)
    cause = "create_timer is called nowhere." if not code.calls("create_timer") else "The line is never reached."
    return failed("never-logs", seen, expected, cause, where=evidence.place(*LEVELS))


def _other_format(evidence: Evidence, params: LogFormat, said: list[str], expected: str) -> Finding:
    line = said[-1]
    seen = f'The log says "{shorten(line, 90)}".'
    diagnosis, cause = "log-format", "Compare it letter by letter: capitals, blanks and points count."
    pattern = lines.Format(params.format).pattern()
    if re.fullmatch(pattern.pattern, line, re.IGNORECASE | re.ASCII):
        diagnosis, cause = "log-capitals", "Capital and small letters differ."
    elif re.search(rf"{pattern.pattern}(?!\.?\d)", line, re.ASCII):  # (not a number of which a part fits)
        diagnosis, cause = "log-more", "There is more on the line than what is asked for."
    elif _same_words(line, params.format):
        diagnosis, cause = "log-numbers", "The words are right; the numbers have another form, or are missing."
        if ":." in params.format:
            cause += " In an f-string {value:.2f} writes two digits behind the point."
    return failed(diagnosis, seen, expected, cause, where=evidence.place(*LEVELS))


def _same_words(line: str, format_: str) -> bool:
    """Whether only the numbers differ."""
    words = re.sub(r"[-+]?[\d.]+(e[-+]?\d+)?|\bnan\b|\binf\b", "", line)
    return "".join(words.split()) == "".join(lines.FIELD.sub("", format_).split())


@dataclass(frozen=True, kw_only=True)
class LogRate(Rate):
    """As the rate of commands, for lines in the format."""

    format: str = text("a line of the log, with its numbers in braces", about=FORMAT)


def log_rate(evidence: Evidence, params: LogRate) -> Finding:
    """Lines in the format arrive at the rate."""
    arrivals = (line.t_s for line in lines.in_format(evidence.recording, params.format))
    return rate_of(evidence, params, LOG_LINE, measure_arrivals(evidence.recording, arrivals))


@dataclass(frozen=True, kw_only=True)
class Counter:
    """The number in the line that counts, by the name that it has in the format, and where it begins."""

    format: str = text("a line of the log, with its numbers in braces", about=FORMAT)
    counts: str = text("the name of a number in the format", about="The number in the format that counts.")
    first: float = number(0.0, about="Where the counter begins.")


def log_counter(evidence: Evidence, params: Counter) -> Finding:
    """The number begins as asked and rises by one from line to line."""
    numbers = [line.numbers[params.counts] for line in lines.in_format(evidence.recording, params.format)]
    form = lines.Format(params.format)
    expected = f'"{form.example(params.first)}", then "{form.example(params.first + 1)}", and so on.'
    where = evidence.place(*LEVELS)
    if len(numbers) < 2:
        seen = "There are not two lines to compare."
        return failed("too-few-log-lines", seen, expected, ended_early(evidence), where=where)
    steps = [later - earlier for earlier, later in pairwise(numbers)]
    if not any(steps):
        seen = f"The number stays {numbers[0]:.0f}."
        cause = "What must live from one call to the next is kept in self, and raised in each."
        return failed("counter-stuck", seen, expected, cause, where=where)
    if any(step != 1.0 for step in steps):
        at = next(index for index, step in enumerate(steps) if step != 1.0)
        seen = f"After {numbers[at]:.0f} comes {numbers[at + 1]:.0f}."
        return failed("counter-step", seen, expected, "Each line is to be one more than the one before.", where=where)
    if numbers[0] != params.first:
        seen = f"The first number is {numbers[0]:.0f}."
        cause = "Log first, then count." if numbers[0] == params.first + 1 else f"Begin with {shown(params.first)}."
        return failed("counter-start", seen, expected, cause, where=where)
    return passed(f"The counter rises from {params.first:.0f}, by one a line.")


LOG_LINES = Kind(
    "log_lines",
    "trial",
    "The log has the lines",
    LogFormat,
    log_lines,
    about="The node logs lines in the given format.",
)
LOG_RATE = Kind(
    "log_rate",
    "trial",
    "Log lines come at the right rate",
    LogRate,
    log_rate,
    about="Lines in the given format arrive at the given rate, from soon after the start until the end.",
)
LOG_COUNTER = Kind(
    "log_counter",
    "trial",
    "The counter rises",
    Counter,
    log_counter,
    about="A number in the lines begins as given and rises by one from line to line.",
)
