"""Code that hides every error is named beside a cause that is only a possibility, and nowhere else."""

from __future__ import annotations

import pytest

from grader.checks.cause import Cause
from grader.checks.causes.hidden_error import with_hidden_error
from grader.checks.judge import judge
from grader.checks.outcome import Finding, Status, failed
from grader.submission.where import Where
from grader.tests.checks.crashes import LOOK, line_with
from grader.tests.checks.made import NODE_FILE, evidence, node, submission
from grader.tests.checks.shapes import SHAPES

NODE = """\
class Driver(Node):
    def step(self):
        try:
            {body}
        {handler}
            {then}


rclpy.spin(Driver())
"""
PLACE = Where(NODE_FILE, 9)


def told(source: str, given: Cause) -> Finding:
    return with_hidden_error(failed("a", "b", given), evidence(package=submission({NODE_FILE: source})))


def cause(source: str) -> str:
    return told(source, Cause("not-moving", "A cause.", PLACE)).cause


def trying(body: str = "self.drive()", handler: str = "except:  # look", then: str = "pass") -> str:
    return NODE.format(body=body, handler=handler, then=then)


def suppressing(context: str, body: str = "self.drive()") -> str:
    return NODE.split("        try:")[0] + f"        with {context}:  # look\n            {body}\n"


@pytest.mark.parametrize(
    "source",
    [
        trying(),
        trying(handler="except Exception:  # look"),
        trying(handler="except BaseException as error:  # look"),
        trying(handler="except (ValueError, Exception):  # look", then="return"),
        trying("self.drive()\n            self.destroy_node()"),
        suppressing("suppress(Exception)"),
        suppressing("open(name) as file, contextlib.suppress(OSError, Exception)"),
    ],
)
def test_what_hides_every_error_is_told(source: str) -> None:
    assert cause(source) == f"A cause. Perhaps line {line_with(LOOK, source)} hides an error: print it."


@pytest.mark.parametrize(
    "source",
    [
        trying(handler="except ValueError:"),
        trying(handler="except (KeyboardInterrupt, ExternalShutdownException):"),
        trying(handler="except Exception as error:", then="print(error)"),
        trying(handler="except Exception:", then="raise"),
        trying("self.destroy_node()"),
        trying(handler="finally:"),
        suppressing("suppress(OSError)"),
        suppressing("raises(Exception)"),
        suppressing("suppress(Exception)", "self.destroy_node()"),
    ],
)
def test_what_hides_no_error_of_the_node_is_not_told(source: str) -> None:
    assert cause(source) == "A cause."


@pytest.mark.parametrize("given", [Cause("wrong-value", "It is 3."), Cause("timer-period", "It is 0.8 s.")])
def test_beside_a_certain_cause_it_is_not_told(given: Cause) -> None:
    assert told(trying(), given).cause == given.text


def test_without_a_cause_its_line_is_the_place() -> None:
    source = trying()
    finding = told(source, Cause("not-moving", "", PLACE))
    assert finding.cause == "This line may hide an error. Print the error to see it."
    assert finding.where == Where(NODE_FILE, line_with(LOOK, source))
    assert finding.diagnosis == "not-moving"


def test_of_several_lines_the_nearest_is_told() -> None:
    source = trying() + trying() + trying()
    lines = [number for number, line in enumerate(source.splitlines(), 1) if LOOK in line]
    found = told(source, Cause("not-moving", "A cause.", Where(NODE_FILE, lines[1] + 1)))
    assert f"line {lines[1]} hides" in found.cause


@pytest.mark.parametrize("where", [None, Where("my_robot_controller/other.py", 3)])
def test_a_place_in_another_file_is_told_with_the_file(where: Where | None) -> None:
    source = trying()
    found = told(source, Cause("not-moving", "A cause.", where))
    assert f"Perhaps {NODE_FILE}:{line_with(LOOK, source)} hides" in found.cause
    assert found.where == where


def test_a_cause_at_the_line_itself_is_not_told_twice() -> None:
    source = trying()
    assert told(source, Cause("not-moving", "A cause.", Where(NODE_FILE, line_with(LOOK, source)))).cause == "A cause."


@pytest.mark.parametrize(("handler", "told_"), [("except Exception:", True), ("except ValueError:", False)])
def test_a_report_names_the_line_that_hides_an_error(handler: str, *, told_: bool) -> None:
    hidden = f"msg = Twist()\n        try:\n            print(msg.speed)\n        {handler}\n            return"
    outcomes = {each.id: each for each in judge(evidence(SHAPES["three quarters"](), node(("msg = Twist()", hidden))))}
    assert outcomes["circle"].status is Status.FAILED
    assert ("hides an error: print it." in outcomes["circle"].finding.cause) == told_
