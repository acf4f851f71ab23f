"""Checks of a program that reads a bag: the line that it prints, and its error if the bag contains no poses."""

from __future__ import annotations

import ast
import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import read_traceback
from grader.checks.causes.why_fit import Fit, uses_extremes, why_fit
from grader.checks.kind import Kind, string, strings
from grader.checks.outcome import Finding, failed, passed
from grader.checks.subjects.fit import stopped, tolerances
from grader.checks.subjects.log import FORMAT
from grader.common.words import shorten
from grader.evidence.student_log import Format
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.exercise.call_inputs import BagInput
    from grader.trial.called import Called

POWERS = ("10 ** 9", "10 ** -9")
"""The number of nanoseconds in a second and its inverse, written as powers of ten."""
HUNDREDTH = 0.0101
"""The maximum error of a printed value, which has two decimal places and may be truncated instead of rounded."""


@dataclass(frozen=True, kw_only=True)
class OneRun:
    """One run of the program with the path of a bag."""

    call: str = string("the id of a call", about="The id of a `[[trial.bag]]`.")


@dataclass(frozen=True, kw_only=True)
class Printed(OneRun):
    """One run of the program, and the names of the printed numbers that are compared."""

    format: str = string("a line with replacement fields", about=FORMAT)
    values: tuple[str, ...] = strings(about='The numbers that are compared: "messages", "rate", "x", "y", "radius".')


def prints(evidence: Evidence, params: Printed) -> Finding:
    """The program prints a line with the right numbers."""
    called = evidence.called(params.call)
    bag = _bag(evidence, params.call)
    name = evidence.trial.executable
    truth = _truth(bag)
    expected = f"{name} bags/{bag.id} prints {_line(params.format, truth)}"
    crash = read_traceback(called.stderr, evidence.submission.files)
    program = _first_argument(evidence)
    if crash is not None and crash.error == "AnyReaderError" and program is not None:
        text = "sys.argv[0] is the name of the program. The first argument is sys.argv[1]."
        return failed(f"{name} raised {crash.observed}.", expected, Cause("own-name-read", text, program))
    if crash is not None and crash.error == "FileNotFoundError" and bag.id not in crash.message:
        text = "The program must open the bag that its first argument names, whatever the name is: sys.argv[1]."
        return failed(f"{name} raised {crash.observed}.", expected, Cause("own-name-read", text, crash.where))
    if crash is not None and crash.error == "AttributeError" and "Twist" in crash.message:
        observed = f"{name} raised {crash.observed}."
        cause = "The program used a command as a pose. Read only the messages on the topic of the poses."
        return failed(observed, expected, Cause("all-messages", cause, crash.where))
    broken = _stopped(evidence, called, expected, name, bag)
    if broken is not None:
        return broken
    lines = [line.strip() for line in called.stdout.splitlines() if line.strip()]
    pattern = Format(params.format).pattern()
    logged = called.stderr.splitlines() if not any(map(pattern.fullmatch, lines)) else []
    if any(pattern.fullmatch(line.strip().rpartition("]: ")[2]) for line in logged):
        cause = "The line is on stderr, where the log goes. Write it to stdout, as print does by default."
        log = evidence.place("info", "warning", "warn", "error", "debug", "print")
        return failed(f"{name} did not print the line.", expected, Cause("prints-nothing", cause, log))
    if not lines:
        cause = "print writes a line. The function that the entry point names must reach the line with print."
        return failed(f"{name} printed nothing.", expected, Cause("prints-nothing", cause, evidence.code.start))
    found = next((match for match in map(pattern.fullmatch, lines) if match is not None), None)
    where = evidence.place("print")
    if found is None and re.search(r"\bnan\b", lines[-1]):
        cause = "NaN is the result of an undefined computation. Which computation returns NaN?"
        return failed(f'{name} printed "{shorten(lines[-1], 80)}".', expected, Cause("not-a-number", cause, where))
    if found is None:
        cause = "Compare the line letter by letter: names, spaces and the digits after the decimal point matter."
        return failed(f'{name} printed "{shorten(lines[-1], 80)}".', expected, Cause("print-format", cause, where))
    given = {key: float(value) for key, value in found.groupdict().items()}
    wrong = [key for key in params.values if not abs(given[key] - truth[key]) <= _within(bag)[key]]
    if not wrong:
        return passed(f'{name} printed "{shorten(found[0], 80)}".')
    return failed(
        f'{name} printed "{shorten(found[0], 80)}".', expected, _why(evidence, wrong[0], given, bag).at(where)
    )


def _stopped(evidence: Evidence, called: Called, expected: str, name: str, bag: BagInput) -> Finding | None:
    """Return a finding if the program did not end in time or did not end with exit code 0, else None."""
    broken = stopped(evidence, called, expected, name)
    if broken is not None and broken.diagnosis == "call-ended" and not broken.cause and called.stderr.strip():
        text = f"The bag contains {bag.arc.count} poses. Does the program find all of them before it ends?"
        return broken.because(Cause("call-ended", text, evidence.place("exit")))
    return broken


def ends_with_message(evidence: Evidence, params: OneRun) -> Finding:
    """If the bag contains no pose, the program exits with a message and an exit code other than 0."""
    called = evidence.called(params.call)
    name = evidence.trial.executable
    expected = f"{name} prints one sentence about what is missing, and ends with an exit code other than 0."
    crash = read_traceback(called.stderr, evidence.submission.files)
    if crash is not None:
        cause = "A traceback does not help a user. If there are no poses, call sys.exit with a sentence."
        if "Twist" in crash.message:
            cause = "The program used a command as a pose. AnyReader.messages([]) returns the messages on all topics."
        observed = f"For a bag without poses, {name} ended with {crash.observed}."
        return failed(observed, expected, Cause("program-traceback", cause, crash.where))
    if called.ended == "exit 0":
        cause = (
            "The exit code tells other programs whether this program failed. If you call sys.exit with a string, the "
            "exit code is 1."
        )
        observed = f"For a bag without poses, {name} ended with exit code 0."
        return failed(observed, expected, Cause("exit-code", cause, evidence.place("exit", "print")))
    if not called.ended.startswith("exit"):
        observed = f"For a bag without poses, {name} did not exit by itself ({called.ended or 'no result'})."
        return failed(observed, expected, Cause("exit-code", "", evidence.place("exit")))
    printed = (called.stderr.strip() or called.stdout.strip()).splitlines()
    if not printed:
        observed = f"For a bag without poses, {name} printed no message ({called.ended})."
        cause = "If you call sys.exit with a string, Python prints the string."
        return failed(observed, expected, Cause("exit-code", cause, evidence.place("exit")))
    return passed(f'{name} printed "{shorten(printed[-1], 80)}".')


def _why(evidence: Evidence, key: str, given: dict[str, float], bag: BagInput) -> Cause:
    count, rate = bag.arc.count, bag.rate_hz
    more = count + bag.commands
    if key == "messages" and given[key] == more:
        return Cause("all-messages", "All messages in the bag were counted, not only the poses.")
    if key == "rate":
        value = given[key]
        if abs(value * 1e9 - rate) <= rate and not _has_a_billion(evidence):
            return Cause(
                "nanoseconds", "Time stamps in a bag are in nanoseconds. A second has 1,000,000,000 nanoseconds."
            )
        if abs(value - rate * count / (count - 1)) <= HUNDREDTH:
            return Cause(
                "rate-off-by-one",
                "The number of messages divided by the duration is too high: n messages have only n - 1 intervals.",
            )
        if abs(value - 1.0 / rate) <= HUNDREDTH:
            return Cause(
                "period-for-rate",
                "This is the time between two messages in seconds. The rate is 1 divided by this time.",
            )
        rounded = _rounded_down(evidence, value, bag)
        if rounded is not None:
            return rounded
        return Cause(
            "wrong-rate", "The rate is the number of intervals divided by the time from the first to the last message."
        )
    if key in ("x", "y", "radius"):
        within = _within(bag)
        values = (given["x"], given["y"], given["radius"])
        known = (within["x"], within["y"], within["radius"])
        return why_fit(Fit(bag.arc, values, known, extremes=uses_extremes(evidence.code)))
    return Cause("wrong-count", "Each message on the topic counts once.")


def _has_a_billion(evidence: Evidence) -> bool:
    """Return whether the program contains the number of nanoseconds in a second, or its inverse."""
    nodes = [node for module in evidence.code.modules for node in module.nodes]
    constants = any(isinstance(node, ast.Constant) and node.value in (1e9, 1e-9) for node in nodes)
    return constants or any(isinstance(node, ast.BinOp) and ast.unparse(node) in POWERS for node in nodes)


def _rounded_down(evidence: Evidence, value: float, bag: BagInput) -> Cause | None:
    """Return the cause if // rounded the rate, or the time in its formula, down to a whole number, else None."""
    intervals, rate = bag.arc.count - 1, bag.rate_hz
    seconds = intervals / rate
    whole = {math.floor(rate), *(intervals / each for each in (math.floor(seconds), math.ceil(seconds)) if each)}
    if not any(abs(value - each) <= HUNDREDTH for each in whole):
        return None
    for module in evidence.code.modules:
        for node in module.nodes:
            if isinstance(node, ast.BinOp | ast.AugAssign) and isinstance(node.op, ast.FloorDiv):
                text = "// rounds down to a whole number, so the decimal places are lost. / keeps the decimal places."
                return Cause("wrong-rate", text, Where(module.file, node.lineno))
    return None


def _truth(bag: BagInput) -> dict[str, float]:
    arc = bag.arc
    return {"messages": arc.count, "rate": bag.rate_hz, "x": arc.x_m, "y": arc.y_m, "radius": arc.radius_m}


def _within(bag: BagInput) -> dict[str, float]:
    x, y, radius = tolerances(bag.arc, HUNDREDTH)
    return {"messages": 0.0, "rate": HUNDREDTH, "x": x, "y": y, "radius": radius}


def _line(form: str, truth: dict[str, float]) -> str:
    return form.format(**{key: round(value) if key == "messages" else value for key, value in truth.items()})


def _first_argument(evidence: Evidence) -> Where | None:
    """Return the place of a call that gets sys.argv[0] as an argument, else None."""
    for module in evidence.code.modules:
        for call in (node for node in module.nodes if isinstance(node, ast.Call)):
            for given in call.args:
                if isinstance(given, ast.Subscript) and ast.unparse(given) in ("sys.argv[0]", "argv[0]"):
                    return Where(module.file, call.lineno)
    return None


def _bag(evidence: Evidence, id_: str) -> BagInput:
    return next(each for each in evidence.trial.calls.bags if each.id == id_)


PRINTS = Kind(
    "prints_report",
    "trial",
    "The program prints the content of the bag",
    Printed,
    prints,
    about="The argument of the executable is the path of a `[[trial.bag]]`. The executable prints a line in the given "
    "format with the right numbers for the poses in the bag, and ends with exit code 0.",
)
ENDS = Kind(
    "ends_with_message",
    "trial",
    "The program reports what is missing",
    OneRun,
    ends_with_message,
    about="The argument of the executable is the path of a `[[trial.bag]]` without poses. The executable prints a "
    "sentence and ends with an exit code other than 0, without a traceback.",
)
