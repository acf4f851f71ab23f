"""Explain why a student's tests do not pass on the correct node."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.weak_tests import always_false
from grader.checks.causes.why_hung import waits_for_a_person, why_hung
from grader.checks.causes.why_not_collected import why_not_collected
from grader.checks.causes.why_test_import import why_test_import
from grader.checks.causes.why_test_raised import why_test_raised
from grader.common.words import shorten
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.checks.diagnosis import Diagnosis
    from grader.submission.pytest_files import TestCode
    from grader.testbench.result import NodeRun

FIXTURE = re.compile(r"fixture '(?P<name>\w+)' not found")
UNNAMED = re.compile(r"'FixtureFunctionDefinition' object|Fixture \"\w+\" called directly")
FIELD = re.compile(r"The '(?P<name>\w+)' field must be of type 'float'")
TWICE = re.compile(r"Context\.init\(\) must only be called once")
NOT_YET = re.compile(
    r"NotInitializedException|rclpy\.init\(\) has not been called|[Cc]ontext (?:is|was) not (?:valid|initialized)"
)
OUTSIDE = re.compile(
    r"no display|cannot connect to X|DISPLAY|tkinter|TclError|Network is unreachable|Name or service not known|"
    r"Temporary failure in name resolution|gaierror|Connection refused"
)
OF_THE_NODE = re.compile(r"cannot import name '(?P<name>[A-Z][A-Z0-9_]*)' from '[\w.]*\bwall_guard'")
"""Matches pytest's message about a constant that cannot be imported from the module of the node."""
STYLE = re.compile(r"No module named '(?P<name>ament_(?:copyright|flake8|pep257|mypy|xmllint))")
"""Matches the message about a missing package that checks code style. Test files of `ros2 pkg create` import three."""
IDENTITY = re.compile(r"(?:E\s+)?(?:AssertionError: )?assert (?P<left>\S+) is (?!not\b)(?P<right>\S+)")
"""Matches pytest's message about an assert with `is`."""
USAGE_ERROR = 4
"""The exit code of pytest if an option is wrong, or if conftest.py cannot be imported."""
UNCALLED = re.compile(r"assert [^\n]*<(?:bound method|function|built-in (?:function|method)) (?P<name>[\w.]+)")
"""Matches pytest's message about an assert that compares a function with something."""
MESSAGES: dict[str, tuple[Diagnosis, str]] = {
    "fixture function has more than one 'yield'": (
        "fixture-missing",
        "A fixture has one yield. The lines before it prepare the object, and the lines after it clean up.",
    ),
    "async def functions are not natively supported": (
        "test-function-name",
        "pytest does not run functions that are defined with async def. Write def.",
    ),
    "approx() is not supported in a boolean context": (
        "compares-only",
        "pytest.approx is one side of a comparison: assert value == pytest.approx(expected).",
    ),
    "Failed to create subscription": (
        "second-type",
        "A topic has one type. Does the test subscribe with the type with which the node publishes?",
    ),
    "Failed to create publisher": (
        "second-type",
        "A topic has one type. Does the test publish with the type to which the node subscribes?",
    ),
    "type must be an instance of '<enum 'Type'>'": (
        "rejects-right",
        'The second argument of Parameter is the type. Name the value: Parameter("use_sim_time", value=True).',
    ),
    "'Parameter' object is not iterable": (
        "rejects-right",
        "set_parameters takes a list. Write brackets around the parameter: set_parameters([Parameter(...)]).",
    ),
}
"""Maps a part of a message of pytest or rclpy to the diagnosis and the cause that it shows."""
ERROR = re.compile(r"^E\s+(?P<text>\w*(?:Error|Exception|Interrupt)\b.*)$", re.MULTILINE)


def place_of(run: NodeRun, code: TestCode) -> Where | None:
    """Return the line of the first failure in the student's test files, or else only its file, or None."""
    for module in code.modules:
        if run.file.endswith(f"/{module.file}") and run.line > 0:
            return Where(module.file, run.line)
    name = run.test.partition("::")[0]
    return next((Where(module.file) for module in code.modules if module.file == name), None)


def why_rejected(run: NodeRun, code: TestCode, numbers: str = "", node: tuple[str, str] | None = None) -> Cause:
    """Return the reason why this run of the tests on the correct node did not pass.

    `node` is the module and the class of the node. `numbers` are the student's own numbers, as in "speed_m_s = 1.1".
    """
    where = place_of(run, code)
    if run.over:
        return why_hung(code, where)
    if run.exit_code == USAGE_ERROR and not run.test:
        text = (
            "pytest refuses an option in pytest.ini, setup.cfg or pyproject.toml, or cannot import conftest.py. The "
            "grader runs pytest without plugins, so it has no options such as --cov."
        )
        return Cause("rejects-right", text, _configuration(code))
    known = waits_for_a_person(run.message, code) or why_not_collected(run, code) or _known(run.message, where)
    if known is not None:
        return known
    if run.outcome == "import":
        return why_test_import(last_error(run.message), code, node, where)
    false = always_false(code) or why_test_raised(run.message, code, where)
    if false is not None:
        return false
    text = "Compare the test with the promises in wall_guard.py. Does the test give the node enough time?"
    if numbers:
        text = f"Compare the test with the promises, and with your numbers: {numbers}. Does the node get enough time?"
    return Cause("rejects-right", text, where)


def _configuration(code: TestCode) -> Where | None:
    """Return the first conftest.py, or None."""
    return next((Where(each.file) for each in code.modules if each.file.rpartition("/")[2] == "conftest.py"), None)


def why_wrong_tests(run: NodeRun, code: TestCode, name: str) -> Cause | None:
    """Return the cause if the tests compare objects with `is`, or define the class `name` of the node, else None."""
    own = own_copy(code, name)
    if own is not None:
        return own
    compared = IDENTITY.match(run.message)
    if compared is not None and compared["right"] not in ("None", "True", "False"):
        text = "is compares two objects, not their values. Write == instead."
        return Cause("rejects-right", text, place_of(run, code))
    return None


def own_copy(code: TestCode, name: str) -> Cause | None:
    """Return the cause if the test files define the class of the node instead of importing it, else None."""
    for module in code.modules:
        for node in module.nodes:
            if isinstance(node, ast.ClassDef) and node.name == name:
                text = f"The tests define their own class {name}, so they do not test the node. Import the class."
                return Cause("rejects-right", text, Where(module.file, node.lineno))
    return None


def _known(message: str, where: Where | None) -> Cause | None:
    """Return the cause if pytest's message alone shows it, else None."""
    fixture = FIXTURE.search(message)
    if fixture is not None:
        text = (
            f"No fixture is named {shorten(fixture['name'], 60)}. Does a function with this name have the "
            "decorator pytest.fixture? Each parameter of a test is the name of a fixture, or a name in parametrize."
        )
        return Cause("fixture-missing", text, where)
    unnamed = UNNAMED.search(message)
    if unnamed is not None:
        text = "The name of the fixture is not a parameter of the test, so it refers to the fixture function itself."
        return Cause("fixture-missing", text, where)
    field = FIELD.search(message)
    if field is not None:
        text = f"The field {shorten(field['name'], 60)} is a float. Write the number with a decimal point."
        return Cause("int-for-float", text, where)
    uncalled = UNCALLED.match(message.removeprefix("E ").strip())
    if uncalled is not None:
        name = shorten(uncalled["name"].rpartition(".")[2], 60)
        text = f"{name} is a function, and the test compares the function itself. Call it: {name}(...)."
        return Cause("compares-only", text, where)
    for part, (diagnosis, text) in MESSAGES.items():
        if part in message:
            return Cause(diagnosis, text, where)
    return _of_ros(message, where)


def _of_ros(message: str, where: Where | None) -> Cause | None:
    if TWICE.search(message):
        text = (
            "rclpy.init was called twice without rclpy.shutdown in between. In a fixture, call rclpy.init before the "
            "yield and rclpy.shutdown after it. Call neither in the tests."
        )
        return Cause("not-shut-down", text, where)
    if NOT_YET.search(message):
        text = (
            "A node can exist only between rclpy.init and rclpy.shutdown. In a fixture, call rclpy.init before the "
            "yield and rclpy.shutdown after it."
        )
        return Cause("no-init", text, where)
    if OUTSIDE.search(last_error(message)):
        text = "A test must also run without a display and without a network."
        return Cause("needs-the-outside", text, where)
    style = STYLE.search(message)
    if style is not None:
        text = (
            f"The file needs {style['name']}, which the grader does not have. `ros2 pkg create` writes such files; "
            "they check the style of the code, not the node. Remove the file."
        )
        return Cause("test-import", text, where)
    constant = OF_THE_NODE.search(message)
    if constant is not None:
        text = f"Only the class is promised, not {shorten(constant['name'], 60)}. Write your numbers into the tests."
        return Cause("test-import", text, where)
    return None


def last_error(message: str) -> str:
    """Return the last exception in an excerpt of pytest's output, or else its first 150 characters, on one line."""
    found = [match["text"] for match in ERROR.finditer(message)]
    return found[-1] if found else " ".join(message.removeprefix("E ").split())[:150]
