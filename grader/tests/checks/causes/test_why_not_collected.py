"""The reasons why pytest cannot collect tests with parametrize, each with a message that is nearly the same."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_not_collected import of_collection, why_not_collected
from grader.submission.pytest_files import read_test_code
from grader.testbench.result import NodeRun

FILE = "test/test_guard.py"
ONE = "@pytest.mark.parametrize('x', [1.0])\ndef test_{}(bench, x):\n    assert bench\n\n\n"
CODE = read_test_code({FILE: f"import pytest\n{ONE.format('it')}{ONE.format('other')}".encode()}, "my_package")


@pytest.mark.parametrize(
    ("message", "words", "line"),
    [
        (f"In {FILE}::test_other: function uses no argument 'y'", "parametrize has the name y, but the test has no", 7),
        (
            f'{FILE}::test_other: in "parametrize" the number of names (2): must be',
            "parametrize takes a string with",
            7,
        ),
        ("TypeError: Metafunc.parametrize() takes 3 positional arguments but 6", "parametrize takes a string with", 2),
        ("'yield' keyword is allowed in fixtures, but not in tests (test_other)", "test_other has a yield. Only a", 8),
        ("Failed: Unknown 'parameterize' mark, did you mean 'parametrize'?", None, None),
        ("NameError: name 'fixture' is not defined", None, None),
    ],
)
def test_the_arguments_of_collection_are_explained(message: str, words: str | None, line: int | None) -> None:
    run = NodeRun("", 2, test=FILE, outcome="import", message=message)
    cause = why_not_collected(run, CODE)
    assert (cause and cause.where and cause.where.line) == line
    assert (cause is not None and words is not None and cause.text.startswith(words)) == (words is not None)
    assert of_collection(run) == (not message.startswith("NameError"))
