"""The student's own numbers in the constants of a module."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise
from grader.checks.outcome import Status
from grader.checks.subjects.own_constants import CONSTANTS
from grader.evidence.evidence import Evidence
from grader.exercise.own_numbers import draw_numbers, to_toml
from grader.tests.checks.made import submission
from grader.tests.checks.told import told

if TYPE_CHECKING:
    from grader.checks.outcome import Finding

STEP = find_exercise("12-tests")
assert STEP.numbers is not None
NUMBERS = draw_numbers(STEP.numbers, "reader")
SPEED, TURN, TIMEOUT = (float(NUMBERS.values[name]) for name in ("speed_m_s", "turn_rad_s", "timeout_s"))
FILE = "my_robot_controller/wall_guard.py"
USES = "command.linear.x = SPEED\ncommand.angular.z = TURN\nlimit = Duration(seconds=TIMEOUT)\n"
UNUSED = f"SPEED = {SPEED}  # m/s\nTURN = {TURN}\nTIMEOUT = {TIMEOUT}\n"
RIGHT = UNUSED + USES
STARTING_POINT = "SPEED = 1.0  # m/s\nTURN = 1.5\nTIMEOUT = 1.0\n" + USES
LITERALS = f"command.linear.x = {SPEED}\ncommand.angular.z = {TURN}\nlimit = Duration(seconds={TIMEOUT})\n"
IN_CLASS = f"""\
class WallGuard:
    SPEED = {SPEED}
    TURN = {TURN}
    TIMEOUT = {TIMEOUT}

    def drive(self):
        self.send(self.SPEED, self.TURN, getattr(self, "TIMEOUT"))
"""
CHECK = next(check for check in STEP.checks if check.kind == "own_constants")


def judged(source: str | None, **more: str) -> Finding:
    """Return the finding about a wall_guard.py with this source, and about more modules of the package."""
    others = {f"my_robot_controller/{name}.py": text for name, text in more.items()}
    files = {FILE: source, STEP.numbers.file: to_toml(NUMBERS), **others}  # type: ignore[union-attr]
    return CONSTANTS.judge(Evidence(STEP, submission(files)), CHECK.params)


@pytest.mark.parametrize(
    "source",
    [
        RIGHT,
        f"SPEED, TURN, TIMEOUT = {SPEED}, {TURN}, {TIMEOUT}\n" + USES,
        f"SPEED: float = {SPEED}\nTURN: float = 2 * {TURN} / 2\nTIMEOUT: float = {TIMEOUT}\n" + USES,
        IN_CLASS,
        STARTING_POINT + RIGHT,
        LITERALS,
        f"from my_robot_controller.numbers import *\n# {SPEED}\n" + LITERALS,
        "SPEED, TURN, TIMEOUT = read_numbers()\n",
        "SPEED = read()['speed_m_s']\nTURN = read()['turn_rad_s']\nTIMEOUT = read()['timeout_s']\n",
    ],
)
def test_the_own_numbers_pass_wherever_the_module_has_them(source: str) -> None:
    assert judged(source).status is Status.PASSED


def test_the_numbers_may_be_in_a_module_that_the_node_imports() -> None:
    imported = "from my_robot_controller.numbers import SPEED, TIMEOUT, TURN\n"
    assert judged(imported, numbers=RIGHT).status is Status.PASSED
    wrong = judged(imported, numbers=STARTING_POINT)
    assert (wrong.diagnosis, str(wrong.where)) == ("own-number-missing", "my_robot_controller/numbers.py:1")


def test_a_constant_that_no_code_uses_is_not_enough() -> None:
    finding = judged(UNUSED + USES.replace("= TURN", "= 1.5"))
    assert (finding.observed, finding.diagnosis) == (f"{FILE} does not use TURN.", "own-number-missing")
    assert str(finding.where) == f"{FILE}:2"
    assert judged(UNUSED + "print(SPEED, TURN)\nTIMEOUT\n").status is Status.PASSED


def test_a_number_in_a_module_that_the_node_does_not_import_is_not_enough() -> None:
    assert judged("print()\n", numbers=RIGHT).diagnosis == "own-number-missing"


@pytest.mark.parametrize(
    ("source", "observed", "line"),
    [
        (STARTING_POINT, "SPEED is 1.0.", 1),
        (RIGHT + "SPEED = 1.0\n", "SPEED is 1.0.", 7),
        (RIGHT.replace(f"TURN = {TURN}", "TURN = 1.5"), "TURN is 1.5.", 2),
        (RIGHT.replace(f"TIMEOUT = {TIMEOUT}", "TIMEOUT = 1.0"), "TIMEOUT is 1.0.", 3),
        (LITERALS.replace(str(TURN), "1.5"), f"{FILE} has no constant TURN, and does not contain the number", None),
    ],
)
def test_another_number_is_named_with_its_line(source: str, observed: str, line: int | None) -> None:
    finding = judged(source)
    assert finding.observed.startswith(observed)
    assert finding.diagnosis == "own-number-missing"
    assert finding.where is not None
    assert (finding.where.file, finding.where.line) == (FILE, line)


def test_a_module_that_python_cannot_read_is_reported_as_such() -> None:
    assert judged(RIGHT + "def f(:\n").diagnosis == "syntax-error"


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The package has no module my_robot_controller.wall_guard.", None, RIGHT),
        ("SPEED is 1.0.", STARTING_POINT, RIGHT),
        (" has no constant SPEED, and does not contain the number ", "print()\n", LITERALS),
        ("Write the number into the node. `colcon test` runs your tests on this node.", STARTING_POINT, RIGHT),
        (f"my_robot_controller.wall_guard has your numbers from my_numbers_12.toml: SPEED = {SPEED},", RIGHT, None),
    ],
)
def test_a_sentence_about_the_numbers_of_a_module_is_true(words: str, true: str | None, near: str | None) -> None:
    assert words in told(judged(true))
    if near is not None:
        assert words not in told(judged(near))
