"""Checks of the log in exercises about logging: lines in the right format, at the right rate, with a counter."""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed, ended_early
from grader.checks.causes.log_place import LEVELS, log_place
from grader.checks.causes.sign_for_sum import sign_for_sum
from grader.checks.causes.timers import timer_fault
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_ended import why_ended
from grader.checks.causes.why_not_set import compared_condition
from grader.checks.causes.why_silent import why_nothing, why_qos
from grader.checks.edit import at
from grader.checks.kind import Kind, number, string
from grader.checks.outcome import Finding, Status, failed, passed
from grader.checks.subjects.rate import Rate, Subject, rate_of
from grader.common.words import a_list, count, shorten
from grader.evidence import student_log
from grader.evidence.arrivals import measure_arrivals
from grader.submission.constants import evaluate
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.evidence.evidence import Evidence

LOG_LINE = Subject("log line", "info")
FORMAT = "The format of a line, with a replacement field for each number, such as `Hello {counter}` or `x={x:.2f}`."
UNRECEIVED = "No messages will be received from it"
"""rclpy logs this if a subscription is not compatible with a publisher."""


@dataclass(frozen=True, kw_only=True)
class LogFormat:
    """The format of a log line, with a replacement field for each number, as in "Hello {counter}" or "x={x:.2f}"."""

    format: str = string("a log line with replacement fields", about=FORMAT)


def log_lines(evidence: Evidence, params: LogFormat) -> Finding:
    """Log lines in the required format arrive on /rosout."""
    return lines_in(evidence, params)


def lines_in(evidence: Evidence, params: LogFormat, when: str = "") -> Finding:
    """Return the finding about the log lines. If the evidence has only part of the log, `when` describes this part."""
    example = student_log.Format(params.format).example()
    expected = f'The log contains lines such as "{example}".'
    if student_log.in_format(evidence.recording, params.format):
        return passed(expected)
    crash = crash_of(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, end_observed(evidence), expected)
    logged = [line.text for line in student_log.students(evidence.recording)]
    qos = why_qos(evidence)
    if qos is not None and _received_nothing(evidence):
        nothing = "no such line" if logged else "nothing"
        return failed(f"No message reached the subscription, and {nothing} was logged.", expected, qos)
    if logged:
        return _other_format(evidence, params, logged, expected, when)
    return _printed(evidence, params, expected, when) or _silent(evidence, expected, when)


def _printed(evidence: Evidence, params: LogFormat, expected: str, when: str) -> Finding | None:
    """Return a failed finding if the node prints the required lines, or prints lines and never logs, else None."""
    printed = evidence.recording.stdout.text.splitlines()
    pattern = student_log.Format(params.format).pattern()
    right = any(pattern.search(line) for line in printed)
    logs = any(evidence.code.calls(level) for level in LEVELS)
    if not right and (logs or not printed or not evidence.code.calls("print")):
        return None
    observed = (
        "The lines are printed, not logged." if right else f"The node logged nothing{when}, but it printed lines."
    )
    cause = (
        "print only writes to the terminal. get_logger().info(...) also sends the line to ROS 2, "
        "with the time and the node name."
    )
    return failed(observed, expected, Cause("print-instead", cause, evidence.place("print")))


def _received_nothing(evidence: Evidence) -> bool:
    """Return whether rclpy logged that a subscription of the node receives nothing from a publisher."""
    recording = evidence.recording
    return any(UNRECEIVED in text for text in (recording.stderr.text, *(line.text for line in recording.log)))


def _silent(evidence: Evidence, expected: str, when: str) -> Finding:
    observed = f"The node logged nothing{when}. {end_observed(evidence)}".rstrip()
    code = evidence.code
    if not any(code.calls(level) for level in LEVELS):
        cause = "get_logger().info(...) is never called."
        if code.calls("debug"):
            cause = "Messages of the level debug are not shown. Use get_logger().info(...)."
        return failed(observed, expected, timer_fault(evidence) or Cause("no-log", cause, code.start))
    if evidence.recording.end.by == "itself":
        return failed(observed, expected, why_ended(evidence))
    why = why_nothing(evidence, LEVELS) or compared_condition(evidence)
    if why is not None:
        return failed(observed, expected, why)
    cause = "create_timer is never called." if not code.calls("create_timer") else "The line that logs may never run."
    return failed(observed, expected, Cause("never-logs", cause, evidence.place(*LEVELS)))


def _other_format(evidence: Evidence, params: LogFormat, logged: list[str], expected: str, when: str) -> Finding:
    line = logged[-1]
    observed = f'The last log line{when} is "{shorten(line, 90)}".'
    why = Cause("log-format", "Compare the line letter by letter: capital letters, spaces and dots matter.")
    pattern = student_log.Format(params.format).pattern()
    words = student_log.FIELD.sub(" ", params.format).split()
    if re.search(r"\{[\w.:]+\}", line):
        text = "The line contains the braces themselves. An f-string replaces the braces with a value."
        where = log_place(evidence, line)
        why = Cause("log-numbers", text, where).fixed_by(at(where, '("', '(f"'))
    elif method := re.search(r"<bound method \w+\.(\w+) of ", line):
        why = Cause("log-numbers", f"{method[1]} is a method, so the line shows the method itself instead of a value.")
    elif re.search(r"%[-+.\d]*[dfsi]|\{\}", line):
        text = "A placeholder such as {} or %d is still in the line, so it was not replaced with a value."
        why = Cause("log-numbers", text)
    elif re.fullmatch(pattern.pattern, line, re.IGNORECASE | re.ASCII):
        why = Cause("log-capitals", "Upper and lower case matter.")
    elif re.search(rf"{pattern.pattern}(?!\.?\d)", line, re.ASCII):  # (not only the first digits of a number)
        why = Cause("log-more", "The line contains more than it should.")
    elif _same_words(line, params.format):
        why = _other_numbers(params.format)
    elif missing := [f'"{word}"' for word in words if word not in line]:
        why = replace(why, text=f"The line does not contain {a_list(missing)}.")
    return failed(observed, expected, why.at(log_place(evidence, line)))


def _other_numbers(format_: str) -> Cause:
    text = "The words are right, but the numbers are missing or have the wrong format."
    text += " In an f-string, {value:.2f} writes two decimal places." if ":." in format_ else ""
    return Cause("log-numbers", text)


def unless_other_numbers(finding: Finding, evidence: Evidence, format_: str) -> Finding:
    """Return the finding, or a new one if there are log lines with the right words but numbers in another format.

    A finding that did not fail is always returned unchanged.
    """
    right = student_log.in_format(evidence.recording, format_)
    pattern = student_log.Format(format_).pattern()
    logged = (line.text for line in student_log.students(evidence.recording))
    others = [line for line in logged if _same_words(line, format_) and not pattern.fullmatch(line)]
    if finding.status is not Status.FAILED or not others:
        return finding
    observed = (
        f"The format is wrong in {len(others)} of {count(len(right) + len(others), 'log line')} with the right words, "
        f'for example "{shorten(others[-1], 90)}".'
    )
    return failed(observed, finding.expected, _other_numbers(format_).at(log_place(evidence, others[-1])))


def _same_words(line: str, format_: str) -> bool:
    """Return whether the line has the words of the format, so that only the numbers can differ."""
    words = re.sub(r"[-+]?[\d.]+(e[-+]?\d+)?|\bnan\b|\binf\b", "", line)
    return "".join(words.split()) == "".join(student_log.FIELD.sub("", format_).split())


@dataclass(frozen=True, kw_only=True)
class LogRate(Rate):
    """The parameters of the kind `rate`, but for log lines in the required format."""

    format: str = string("a log line with replacement fields", about=FORMAT)


def log_rate(evidence: Evidence, params: LogRate) -> Finding:
    """Log lines in the required format arrive at the required rate."""
    arrivals = (line.t_s for line in student_log.in_format(evidence.recording, params.format))
    finding = rate_of(evidence, params, LOG_LINE, measure_arrivals(evidence.recording, arrivals))
    return unless_other_numbers(finding, evidence, params.format)


@dataclass(frozen=True, kw_only=True)
class Counter:
    """The name of the counter in the format of a log line, and the first value of the counter."""

    format: str = string("a log line with replacement fields", about=FORMAT)
    counts: str = string("the name of a number in the format", about="The name of the counter in the format.")
    first: float = number(0.0, about="The first value of the counter.")


def log_counter(evidence: Evidence, params: Counter) -> Finding:
    """The logged number starts at the right value and increases by one with each line."""
    numbers = [line.numbers[params.counts] for line in student_log.in_format(evidence.recording, params.format)]
    form = student_log.Format(params.format)
    expected = f'"{form.example(params.first)}", then "{form.example(params.first + 1)}", and so on.'
    where = log_place(evidence, form.example(params.first))
    if len(numbers) < 2:
        observed = "There are fewer than two lines to compare."
        return failed(observed, expected, Cause("too-few-log-lines", ended_early(evidence), where))
    steps = [later - earlier for earlier, later in pairwise(numbers)]
    if not any(steps):
        observed = f"The number is always {numbers[0]:.0f}."
        why = (
            _thrown_away(evidence)
            or sign_for_sum(evidence, "counter-stuck")
            or _set_again(evidence)
            or Cause("counter-stuck", "Store the counter as an attribute of self and increase it in every call.", where)
        )
        return failed(observed, expected, why)
    if any(step != 1.0 for step in steps):
        at = next(index for index, step in enumerate(steps) if step != 1.0)
        observed = f"The number after {numbers[at]:.0f} is {numbers[at + 1]:.0f}."
        step = Cause("counter-step", "Each number must be one more than the previous number.", where)
        return failed(observed, expected, sign_for_sum(evidence, "counter-step") or step)
    if numbers[0] != params.first:
        observed = f"The first number is {numbers[0]:.0f}."
        assigned = next((place for value, place in _starts(evidence) if value == numbers[0]), None)
        too_early = numbers[0] == params.first + 1 and assigned is None
        cause = "Log the number first, then increase it." if too_early else f"Start with {params.first:.0f}."
        return failed(observed, expected, Cause("counter-start", cause, assigned or where))
    return passed(f"The counter starts at {params.first:.0f} and increases by one per line.")


def _thrown_away(evidence: Evidence) -> Cause | None:
    """Return the cause if a line calculates a value but does not store it, else None."""
    for module in evidence.code.modules:
        for node in module.nodes:
            if isinstance(node, ast.Expr) and isinstance(node.value, ast.BinOp | ast.Compare):
                text = f"This line calculates {shorten(ast.unparse(node.value), 40)} but does not store the result."
                where = Where(module.file, node.lineno)
                return Cause("counter-stuck", text, where).fixed_by(at(where, " + ", " += "))
    return None


def _set_again(evidence: Evidence) -> Cause | None:
    """Return the cause if a method that logs assigns a constant to a variable that it also increases, else None."""
    for module in evidence.code.modules:
        for method in (node for node in module.nodes if isinstance(node, ast.FunctionDef) and node.name != "__init__"):
            inside = list(ast.walk(method))
            raised = {ast.unparse(node.target) for node in inside if isinstance(node, ast.AugAssign)}
            for node in inside:
                if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant):
                    names = raised & {ast.unparse(target) for target in node.targets}
                    if names and any(isinstance(each, ast.Call) and _logs(each) for each in inside):
                        text = f"{method.name} sets {shorten(names.pop())} to {ast.unparse(node.value)} in each call."
                        return Cause("counter-stuck", text, Where(module.file, node.lineno))
    return None


def _starts(evidence: Evidence) -> Iterator[tuple[float, Where]]:
    """Yield each number that is assigned to a variable with an operator such as += elsewhere, and its place."""
    for module in evidence.code.modules:
        increased = {ast.unparse(node.target) for node in module.nodes if isinstance(node, ast.AugAssign)}
        for node in module.nodes:
            if isinstance(node, ast.Assign) and increased & {ast.unparse(target) for target in node.targets}:
                value = evaluate(node.value, module.names)
                if isinstance(value, int | float):
                    yield float(value), Where(module.file, node.lineno)


def _logs(call: ast.Call) -> bool:
    return isinstance(call.func, ast.Attribute) and call.func.attr in LEVELS


LOG_LINES = Kind(
    "log_lines",
    "trial",
    "The log contains the lines",
    LogFormat,
    log_lines,
    about="The node logs lines in the given format.",
)
LOG_RATE = Kind(
    "log_rate",
    "trial",
    "Log lines arrive at the right rate",
    LogRate,
    log_rate,
    about="Lines in the given format arrive at the given rate, from soon after the start until the end.",
)
LOG_COUNTER = Kind(
    "log_counter",
    "trial",
    "The counter increases by one",
    Counter,
    log_counter,
    about="The counter in the log lines starts at the given value and increases by one with each line.",
)
