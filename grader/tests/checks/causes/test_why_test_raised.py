"""The reasons for exceptions that a student's test raises, each with a test that is nearly the same."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_rejected import why_rejected
from grader.submission.pytest_files import read_test_code
from grader.testbench.result import NodeRun

FILE = "test/test_guard.py"
MISSING = "TypeError: Bench.run() missing 1 required positional argument: 'steps'"
NO_RUN = "AttributeError: 'TestGuard' object has no attribute 'run'"
FIXTURE = "def bench():\n    {}\n"
CLASS = "class TestGuard:\n    def test_it({}):\n        bench.run()\n"
CASE = "class TestGuard(unittest.TestCase):\n    def test_it(self, bench):\n        bench.run(3)\n"
NO_FIXTURE = "TypeError: TestGuard.test_it() missing 1 required positional argument: 'bench'"
SETUP = (
    "class TestGuard{}:\n    def {}(self):\n        self.node = 3\n\n    def test_it(self):\n        assert self.node\n"
)
NO_NODE = "AttributeError: 'TestGuard' object has no attribute 'node'"
NOTHING = "import pytest\n\n\n@pytest.fixture\ndef bench():\n    yield{}\n\n\ndef test_it(bench):\n    bench.run(3)\n"
NONE = "AttributeError: 'NoneType' object has no attribute 'run'"
RAISES = "The code of the test raises this exception itself, so no assert has failed."
COMPARE = "Compare the test with the promises in wall_guard.py."


@pytest.mark.parametrize(
    ("source", "message", "words", "line"),
    [
        (FIXTURE.format("yield Bench"), MISSING, "Bench is the class itself. Write Bench() to create an object.", 2),
        (FIXTURE.format("return Bench"), MISSING, "Bench is the class itself. Write Bench() to create an object.", 2),
        (FIXTURE.format("yield Bench()"), MISSING, RAISES, 7),
        (CLASS.format("bench"), NO_RUN, "test_it is a method, so its first parameter is self. Write (self, bench).", 2),
        (CLASS.format("self, bench"), NO_RUN, RAISES, 7),
        (f"{CLASS.format('self')}    @classmethod\n    def setup_class(cls):\n        pass\n", NO_RUN, RAISES, 7),
        (f"{CLASS.format('self')}    @staticmethod\n    def wait(steps):\n        pass\n", NO_RUN, RAISES, 7),
        ("", "NameError: name 'Twst' is not defined", f"{RAISES} This name has no value here.", 7),
        (CASE, NO_FIXTURE, "pytest gives no fixtures to the methods of a unittest.TestCase.", 1),
        (SETUP.format("", "setup"), NO_NODE, "pytest does not call setup in this class. The right name is setup_m", 2),
        (SETUP.format("", "setUp"), NO_NODE, "pytest does not call setUp in this class. The right name is setup_m", 2),
        (
            SETUP.format("(TestCase)", "setup"),
            NO_NODE,
            "pytest does not call setup in this class. The right name is setUp",
            2,
        ),
        (SETUP.format("(TestCase)", "setUp"), NO_NODE, RAISES, 7),
        (SETUP.format("", "setup_method"), NO_NODE, RAISES, 7),
        (NOTHING.format(""), NONE, "The fixture bench yields no value, so the test gets None. Write yield Bench().", 5),
        (NOTHING.format(" Bench()"), NONE, RAISES, 7),
        ("", "RuntimeError: Subscription.__init__(): callback should be callable", RAISES, 7),
        ("def wait():\n    raise TimeoutError('no pose')\n", "TimeoutError: no pose", COMPARE, 7),
        ("", "TimeoutError: no pose", RAISES, 7),
        ("", "AssertionError: assert 4 == 3", COMPARE, 7),
        ("", "assert 4 == 3", COMPARE, 7),
        ("", "IndexError: list index out of range", COMPARE, 7),
        ("", "AssertionError: approx() is not supported in a boolean context.", "pytest.approx is one side of a", 7),
    ],
)
def test_the_message_and_the_source_decide(source: str, message: str, words: str, line: int) -> None:
    code = read_test_code({FILE: source.encode()}, "my_package")
    run = NodeRun("", 1, test=f"{FILE}::test_it", outcome="failed", message=message, file=f"/in/{FILE}", line=7)
    cause = why_rejected(run, code)
    assert cause.text.startswith(words)
    assert cause.where is not None
    assert cause.where.line == line
    assert (RAISES in cause.text) == words.startswith(RAISES)
