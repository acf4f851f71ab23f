"""Checks of the source of a student's tests: they are declared for colcon, and avoid common weaknesses."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.chance import is_seeded
from grader.checks.causes.vacuous_asserts import vacuous_assert
from grader.checks.causes.weak_tests import always_true, timed_loop, why_without_assert, without_assert
from grader.checks.kind import Kind, NoParams, strings
from grader.checks.outcome import Finding, failed, passed
from grader.common.words import a_list, shorten
from grader.submission.extras import extras_of_files
from grader.submission.pytest_files import TestCode, read_test_code
from grader.submission.uses import uses_of
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.submission.setup_py import SetupPy
    from grader.submission.uses import Use

PYTEST = "pytest"
TEST_DEPEND = "python3-pytest"
READERS = frozenset(
    {"open", "read_text", "read_bytes", "getsource", "getsourcelines", "getsourcefile", "find_spec", "get_data"}
)
"""Functions and methods with which a test could read the source of a module."""
SOURCE_MODULES = frozenset({"ast", "inspect", "dis", "linecache", "tokenize", "marshal", "py_compile", "pkgutil"})
"""Modules whose purpose is to look at source or compiled code."""
CODE_ATTRIBUTES = frozenset({"__code__", "co_code", "co_consts", "co_names"})
PROCESS_MODULES = frozenset({"subprocess", "multiprocessing", "launch", "launch_ros", "launch_testing"})
"""Modules whose purpose is to start other processes."""


def code_of(evidence: Evidence) -> TestCode:
    """Return the test code of the submission."""
    return read_test_code(evidence.submission.files, evidence.exercise.package)


def declared(evidence: Evidence, _: NoParams) -> Finding:
    """setup.py (or another file that colcon reads) lists pytest as a test dependency, and so does package.xml."""
    expected = (
        f'setup.py lists "{PYTEST}" under "test" in extras_require, '
        f"and package.xml declares {TEST_DEPEND} as a <test_depend>."
    )
    setup, manifest = evidence.setup_py, evidence.manifest
    if setup is not None and PYTEST not in _tested_with(setup, evidence):
        old = setup.tests_require_line
        cause = "Without this entry, colcon test runs unittest, which does not find pytest's test functions."
        if old is not None:
            cause = "setuptools 72 and later ignore tests_require, so colcon test runs unittest."
        observed = f'setup.py does not list "{PYTEST}" in extras_require.'
        where = Where("setup.py", old or setup.setup_line)
        return failed(observed, expected, Cause("tests-require" if old else "pytest-undeclared", cause, where))
    depends = () if manifest is None else (*manifest.run_depends, *manifest.other_depends)
    if TEST_DEPEND not in depends:
        cause = "On another computer, rosdep installs only the packages that package.xml declares."
        observed = f"package.xml does not declare {TEST_DEPEND}."
        return failed(observed, expected, Cause("pytest-undeclared", cause, Where("package.xml")))
    return passed("colcon test runs the tests with pytest.")


def _tested_with(setup: SetupPy, evidence: Evidence) -> tuple[str, ...]:
    """Return the test dependencies that colcon finds. If setup.py computes them, assume that they are right."""
    if setup.tested_with is None:
        return (PYTEST,)
    return setup.tested_with if setup.has_extras else extras_of_files(evidence.submission.files)


def outside(evidence: Evidence, _: NoParams) -> Finding:
    """The tests do not read the source of the node, and do not start it as another process."""
    code = code_of(evidence)
    expected = "The tests create the node and watch what it publishes. The tests do not read the file of the node."
    for module in code.modules:
        for node in module.nodes:
            name = _imported(node, SOURCE_MODULES) or (getattr(node, "attr", "") if _is_of_code(node) else "")
            if name:
                return failed(
                    f"The tests use {shorten(name, 60)}, which can look at the code of the node.",
                    expected,
                    Cause("looks-at-source", LOOKS, Where(module.file, getattr(node, "lineno", None))),
                )
    uses = _uses(code, READERS)
    use = uses[0] if uses else None
    is_only = len({each.where for each in uses}) == 1
    if use is not None and not (is_only and _reads_numbers(code, use, evidence)):
        observed = f"The tests use {shorten(use.written, 60)}, which can read a file."
        return failed(observed, expected, Cause("looks-at-source", LOOKS, use.where))
    for module in code.modules:
        for node in module.nodes:
            name = _imported(node, PROCESS_MODULES)
            if name:
                observed = f"The tests import {shorten(name, 60)}, which can start other processes."
                where = Where(module.file, getattr(node, "lineno", None))
                return failed(observed, expected, Cause("starts-a-process", SPIN, where))
    return passed("The tests watch the node from outside.")


SPIN = "Import the class, create the node in the test, and spin it. Then the test controls the time."
LOOKS = "The same node can be written in many ways. A test of the source rejects some of the correct nodes."


def _reads_numbers(code: TestCode, use: Use, evidence: Evidence) -> bool:
    """Return whether the file with this use names the file of the student's own numbers, and no Python file."""
    numbers = evidence.exercise.numbers
    nodes = (node for module in code.modules if module.file == use.where.file for node in module.nodes)
    texts = [node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    names = [text.rpartition("/")[2] for text in texts]
    return numbers is not None and numbers.file in names and not any(name.endswith(".py") for name in names)


def _imported(node: ast.AST, modules: frozenset[str]) -> str:
    """Return the name of the imported module if it is one of these modules, or an empty string."""
    if isinstance(node, ast.Import):
        return next((alias.name for alias in node.names if alias.name.partition(".")[0] in modules), "")
    if isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] in modules and not node.level:
        return node.module or ""
    return ""


def _is_of_code(node: ast.AST) -> bool:
    return isinstance(node, ast.Attribute) and node.attr in CODE_ATTRIBUTES


@dataclass(frozen=True, kw_only=True)
class Steady:
    """The names of functions that make a test depend on chance or on the speed of the machine."""

    names: tuple[str, ...] = strings(about="Functions that wait for a fixed time, such as `sleep`.")
    random: tuple[str, ...] = strings(
        about="Functions that return a different result each time, such as `randint`, unless there is a fixed seed."
    )


def steady(evidence: Evidence, params: Steady) -> Finding:
    """The tests neither sleep nor loop for a fixed time, and use random numbers only with a fixed seed."""
    code = code_of(evidence)
    expected = "The tests behave the same in every run, even on a slow computer."
    use = _first_use(code, frozenset(params.names))
    if use is not None:
        cause = "On a slow computer, the sleep may be too short. Spin until the message arrives, or set the clock."
        observed = f"The tests use {shorten(use.written, 60)}."
        return failed(observed, expected, Cause("sleeps-by-luck", cause, use.where))
    loop = timed_loop(code)
    if loop is not None:
        return failed("The tests contain a loop that runs for a fixed time.", expected, loop)
    use = _first_use(code, frozenset(params.random))
    if use is not None and not is_seeded(code, params.random):
        cause = "A failure that occurs only sometimes is hard to reproduce. Choose the values yourself, or use a seed."
        observed = f"The tests use {shorten(use.written, 60)}."
        return failed(observed, expected, Cause("by-chance", cause, use.where))
    return passed(expected)


def asserts(evidence: Evidence, _: NoParams) -> Finding:
    """Every test asserts something."""
    code = code_of(evidence)
    expected = "Every test has an assert that can fail."
    cause = always_true(code) or vacuous_assert(code)
    if cause is not None:
        return failed("An assert is always true.", expected, cause)
    empty = without_assert(code)
    if empty:
        names, cause = a_list([shorten(each.node.name, 60) for each in empty[:3]]), why_without_assert(empty[0])
        always = cause.diagnosis == "assert-vacuous"
        return failed("An assert is always true." if always else f"There is no assert in {names}.", expected, cause)
    return passed(expected)


def _first_use(code: TestCode, names: frozenset[str]) -> Use | None:
    return next(iter(_uses(code, names)), None)


def _uses(code: TestCode, names: frozenset[str]) -> list[Use]:
    return [use for module in code.modules for use in uses_of(code.modules, module.file, names)]


DECLARED = Kind(
    "tests_declared",
    "source",
    "colcon test runs the tests with pytest",
    NoParams,
    declared,
    about="`extras_require` lists pytest under `test`, `tests` or `testing`, in a file that colcon reads (setup.py, "
    "setup.cfg or pyproject.toml), and package.xml declares python3-pytest.",
)
OUTSIDE = Kind(
    "tests_outside",
    "source",
    "The tests watch the node from outside",
    NoParams,
    outside,
    about="The test files do not read source code, and do not start another process. They may read the student's own "
    "numbers.",
)
STEADY = Kind(
    "tests_steady",
    "source",
    "The tests do not depend on chance",
    Steady,
    steady,
    about="The test files use none of the given functions, not even under another name, and contain no loop that runs "
    "for a fixed time. Random numbers with a fixed seed are allowed.",
)
ASSERTS = Kind(
    "tests_assert",
    "source",
    "Every test asserts something",
    NoParams,
    asserts,
    about="Every test function asserts something, or uses a function or fixture that does. No assert is always true "
    "because it tests a tuple, a list or a constant, has a constant after `or`, or compares a value with itself.",
)
