"""Checks of a student's tests when they run: they pass on the correct node, and fail on broken nodes."""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.hidden_failures import left_out, swallowed
from grader.checks.causes.syntax import unreadable_finding
from grader.checks.causes.vacuous_asserts import vacuous_assert, value_as_message, wide_tolerance
from grader.checks.causes.weak_tests import (
    in_a_loop,
    last_name,
    named_twice,
    why_without_assert,
    without_assert,
    without_effect,
)
from grader.checks.causes.why_no_test import why_no_test
from grader.checks.causes.why_not_collected import of_collection
from grader.checks.causes.why_not_heard import why_not_called, why_not_heard
from grader.checks.causes.why_rejected import FIXTURE, last_error, own_copy, why_rejected, why_wrong_tests
from grader.checks.causes.why_test_import import shown_error
from grader.checks.kind import Kind, NoParams, string
from grader.checks.outcome import Finding, failed, passed
from grader.checks.own_values import drawn_numbers
from grader.checks.subjects.tests_written import code_of
from grader.common.words import count, shorten
from grader.exercise.own_numbers import OwnNumbers
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.exercise.node_under_test import Behaviour
    from grader.submission.pytest_files import TestCode, TestFunction
    from grader.testbench.result import NodeRun

MOST_TEXT = 120
ADDRESS = re.compile(r" at 0x[0-9a-f]+")
"""Matches the address of an object, which differs from run to run."""


def found(evidence: Evidence, _: NoParams) -> Finding:
    """The package contains a test, or a test file that cannot be imported."""
    runs = evidence.bench.runs
    most = max((run.collected for run in runs), default=0)
    code = code_of(evidence)
    if most:
        return passed(f"pytest finds {count(most, 'test')}.")
    if code.tests:
        return passed(f"The files contain {count(len(code.tests), 'test')}.")
    if any(run.outcome == "import" for run in runs):
        return passed("pytest finds a test file, but cannot import it.")
    expected = "pytest finds tests: functions named test_SOMETHING in files named test_SOMETHING.py."
    return failed("pytest finds no test.", expected, why_no_test(code))


def pass_(evidence: Evidence, _: NoParams) -> Finding:
    """All tests pass on the correct node in every run."""
    spec = evidence.trial.tests
    assert spec is not None
    runs, code = evidence.bench.right, code_of(evidence)
    expected = "All tests pass on the correct node in every run."
    rejected = [run for run in runs if not run.accepted]
    if not rejected and len(runs) >= spec.right_runs:
        if any(run.passed for run in runs):
            return passed(f"All tests pass on the correct node ({count(len(runs), 'run')}).")
        where = code.tests[0].where if code.tests else None
        skipped = all(run.skipped >= run.collected > 0 for run in runs)
        why = "Every test is skipped, and a skipped test tests nothing." if skipped else LEFT_OUT
        return failed("No test ran to completion.", expected, Cause("all-skipped", why, where))
    if not rejected:
        hung = next((run for run in evidence.bench.runs if run.over), None)
        return _hung(expected, code, hung)
    if len(rejected) < len(runs):
        cause = Cause("unsteady-tests", UNSTEADY, why_rejected(rejected[0], code).where)
        observed = f"The tests pass on the correct node in {len(runs) - len(rejected)} of {count(len(runs), 'run')}."
        return failed(observed, expected, cause)
    for module in code.modules:
        if module.unreadable is not None and module.file == rejected[0].test:
            return unreadable_finding(module.file, module.unreadable, evidence.submission.files[module.file])
    known = why_wrong_tests(rejected[0], code, spec.name) or why_not_heard(rejected[0], code, spec.right)
    cause = known or why_rejected(rejected[0], code, _numbers(evidence), (spec.module, spec.name))
    return failed(_observed(rejected[0]), expected, cause)


def _numbers(evidence: Evidence) -> str:
    """Return the student's own numbers as text, or an empty string if the exercise has none."""
    drawn = drawn_numbers(evidence) if evidence.exercise.numbers is not None else None
    if not isinstance(drawn, OwnNumbers):
        return ""
    return ", ".join(f"{name} = {value}" for name, value in drawn.values.items())


LEFT_OUT = "Options in setup.cfg or pytest.ini can exclude tests, and a test can end pytest itself."
UNSTEADY = "The tests depend on timing, on random numbers, or on the state that an earlier test left."


def _observed(run: NodeRun) -> str:
    if run.over:
        return "The tests did not finish in time on the correct node."
    name = shorten(run.test.rpartition("::")[2] or run.test, 60)
    if run.outcome == "import":
        file = shorten(run.test, 60)
        if of_collection(run):
            return f"pytest cannot collect the tests in {file}."
        error = shown_error(last_error(run.message))
        return f"{file} cannot be imported: {error}." if error else f"{file} cannot be imported."
    if not name:
        return f"The tests on the correct node ended with exit code {run.exit_code}."
    # pytest explains the values of a comparison in lines that begin with "+". They would hide the cause.
    missing = FIXTURE.search(run.message)
    compared = missing.group() if missing else run.message.partition("\n +")[0]
    message = last_error(f"E   {compared}") if compared else ""
    text = shorten(_one_line(message), MOST_TEXT)
    return f"{name} fails on the correct node: {text}." if text else f"{name} fails on the correct node."


def _one_line(text: str) -> str:
    return " ".join(ADDRESS.sub("", text.split("\n")[0]).split()).rstrip(".")


@dataclass(frozen=True, kw_only=True)
class Catches:
    """The broken node that the tests must reject, its description, and the text for students whose tests accept it."""

    broken: str = string("the id of a broken node", about="The `id` of the `[[trial.tests.broken]]`.")
    does: str = string("a description", about="A description of the broken node, such as: a node that turns right.")
    cause: str = string(
        "a reason",
        about="The text that the student reads if all tests pass on the broken node, unless the grader finds a "
        "mistake in the tests.",
    )


def catches(evidence: Evidence, params: Catches) -> Finding:
    """At least one test fails on the broken node."""
    run = evidence.bench.of(params.broken)
    expected = f"At least one test fails on {params.does}."
    code = code_of(evidence)
    if run is None or run.over:
        return _hung(expected, code, run)
    if not run.accepted:
        name = shorten(run.test.rpartition("::")[2], 60)
        return passed(f"{name or 'A test'} fails on {params.does}, as required.")
    observed = f"No test fails on {params.does}."
    return failed(observed, expected, _why_accepted(evidence, params, code, run))


def _why_accepted(evidence: Evidence, params: Catches, code: TestCode, run: NodeRun) -> Cause:
    empty = without_assert(code)
    if empty and len(empty) == len(code.tests):
        return why_without_assert(empty[0])
    spec = evidence.trial.tests
    assert spec is not None
    cause = (
        own_copy(code, spec.name)
        or _no_node(run, code, spec.name)
        or named_twice(code)
        or left_out(run, code)
        or swallowed(code)
        or _why_not_called(evidence, params.broken, code)
    )
    cause = cause or vacuous_assert(code) or value_as_message(code) or _asserts_a_constant(empty)
    if cause is None and _is_silent(evidence, params.broken):
        cause = in_a_loop(code)
    if cause is None and _differs_in_values(evidence, params.broken):
        cause = wide_tolerance(code)
    cause = cause or without_effect(code)
    # No line is wrong: a test is missing.
    where = Where(code.tests[0].module.file) if code.tests else None
    return cause or Cause("accepts-broken", params.cause, where)


def _no_node(run: NodeRun, code: TestCode, name: str) -> Cause | None:
    """Return the cause if the tests never create an object of the node's class, else None."""
    calls = (node.func for module in code.modules for node in module.nodes if isinstance(node, ast.Call))
    if run.events is not None or any(last_name(each) == name for each in calls):
        return None
    where = Where(code.tests[0].module.file) if code.tests else None
    text = f"The tests never create an object of the class {name}, so they do not test the node."
    return Cause("bench-no-node", text, where)


def _asserts_a_constant(empty: tuple[TestFunction, ...]) -> Cause | None:
    """Return the cause if a test of these tests without an assert that can fail asserts a constant, else None."""
    return next((each for each in map(why_without_assert, empty) if each.diagnosis == "assert-vacuous"), None)


def _why_not_called(evidence: Evidence, broken: str, code: TestCode) -> Cause | None:
    spec = evidence.trial.tests
    assert spec is not None
    return why_not_called(evidence.bench.of(broken), code, spec.right)


def _is_silent(evidence: Evidence, broken: str) -> bool:
    """Return whether the tests receive no commands from the broken node."""
    spec = evidence.trial.tests
    assert spec is not None
    behaviours: dict[str, Behaviour] = {each.id: each.behaviour for each in spec.broken}
    of, right = behaviours.get(broken, spec.right), spec.right
    return not of.publishes or of.topic != right.topic or of.type != right.type or of.listens != right.listens


def _differs_in_values(evidence: Evidence, broken: str) -> bool:
    """Return whether the broken node sends as many commands as the correct node, but with other values."""
    spec = evidence.trial.tests
    assert spec is not None
    behaviours: dict[str, Behaviour] = {each.id: each.behaviour for each in spec.broken}
    of, right = behaviours.get(broken, spec.right), spec.right
    return not _is_silent(evidence, broken) and (of.period_s, of.waits) == (right.period_s, right.waits)


def _hung(expected: str, code: TestCode, run: NodeRun | None) -> Finding:
    text = "A test that waits for a message that never arrives must give up: it needs a deadline."
    where = code.tests[0].where if code.tests else None
    observed = (
        "The tests did not finish in time."
        if run is not None
        else "The tests did not finish in time on other nodes, so some runs did not take place."
    )
    return failed(observed, expected, Cause("test-hangs", text, where))


FOUND = Kind(
    "tests_found",
    "trial",
    "pytest finds tests",
    NoParams,
    found,
    about="The package contains at least one test that pytest finds in some run or that the source shows, or a test "
    "file that cannot be imported.",
)
PASS = Kind(
    "tests_pass",
    "trial",
    "The tests pass on the correct node",
    NoParams,
    pass_,
    about="All tests pass in every run on the correct node.",
)
CATCHES = Kind(
    "tests_catch",
    "trial",
    "The tests reject a broken node",
    Catches,
    catches,
    about="At least one test fails on the broken node.",
)
