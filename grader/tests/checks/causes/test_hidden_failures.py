"""The sentences about tests whose failures pytest does not report, each with tests whose failures it reports."""

from __future__ import annotations

import pytest

from grader.checks.causes.hidden_failures import left_out, swallowed
from grader.submission.pytest_files import TestCode, read_test_code
from grader.testbench.result import NodeRun

TRY = "    try:\n        assert bench.heard\n    {handler}\n"
HELPER = "def check(bench):\n    assert bench.heard\n\n\n"


def code(body: str, above: str = "") -> TestCode:
    """Return a test file with one test. `above` is the source code above the test."""
    return read_test_code({"test/test_guard.py": f"{above}def test_it(bench):\n{body}\n".encode()}, "my_package")


@pytest.mark.parametrize(
    ("handler", "after", "found"),
    [
        ("except AssertionError:\n        print('it drives')", "", True),
        ("except:\n        pass", "", True),
        ("except (ValueError, Exception):\n        pass", "", True),
        ("except ValueError:\n        pass", "", False),
        ("except AssertionError:\n        raise", "", False),
        ("except AssertionError:\n        raise\n    except Exception:\n        pass", "", False),
        ("except AssertionError:\n        pytest.fail('it drives')", "", False),
        ("except AssertionError:\n        assert False, 'it drives'", "", False),
        ("except AssertionError:\n        wrong = True", "    assert not wrong", False),
        ("except AssertionError:\n        wrong.append(1)", "    assert not wrong", False),
        ("except AssertionError:\n        wrong = True", "    print(wrong)", True),
        ("except AssertionError:\n        bench.wrong = True", "    assert not bench.wrong", False),
        ("except AssertionError:\n        bench.wrong = True", "    assert bench.heard", True),
        ("except AssertionError:\n        pass\n    else:\n        right = True", "    assert right", False),
    ],
)
def test_an_except_that_hides_a_failure_is_found(handler: str, after: str, *, found: bool) -> None:
    cause = swallowed(code(TRY.format(handler=handler) + after))
    assert (cause is not None) == found
    words = "This except clause catches the AssertionError, so pytest does not notice the failure."
    assert cause is None or (cause.text, cause.where and cause.where.line) == (words, 4)


@pytest.mark.parametrize(("end", "found"), [("pytest.fail('silent')", False), ("print('silent')", True)])
def test_a_loop_that_tries_again_may_fail_in_its_else_block(end: str, *, found: bool) -> None:
    again = "        try:\n            assert bench.heard\n            break\n        except AssertionError:\n"
    body = f"    for _ in range(9):\n{again}            bench.spin()\n    else:\n        {end}"
    assert (swallowed(code(body)) is not None) == found


@pytest.mark.parametrize(
    ("body", "words", "line"),
    [
        ("    with contextlib.suppress(AssertionError):\n        check(bench)", "contextlib.suppress catches the", 6),
        ("    with suppress(Exception):\n        assert bench.heard", "suppress catches the AssertionError, so", 6),
        ("    with suppress(IndexError):\n        check(bench)", None, None),
        ("    with suppress(AssertionError):\n        bench.run(1)\n    check(bench)", None, None),
        ("    with open('log') as log:\n        check(bench)", None, None),
        ("    try:\n        check(bench)\n    finally:\n        return", "return in a finally block discards the", 9),
        ("    while 1:\n        try:\n            check(bench)\n        finally:\n            break", "break in a", 10),
        ("    try:\n        check(bench)\n    finally:\n        bench.close()", None, None),
        ("    try:\n        check(bench)\n    except AssertionError:\n        pass", "This except clause catches", 8),
        (
            "    try:\n        check(bench)\n    except AssertionError:\n        pass\n    else:\n        fail()",
            None,
            None,
        ),
        ("    try:\n        bench.wait()\n    except Exception:\n        pass\n    check(bench)", None, None),
    ],
)
def test_what_discards_a_failure_is_found(body: str, words: str | None, line: int | None) -> None:
    cause = swallowed(code(body, HELPER))
    assert (cause and cause.where and cause.where.line) == line
    assert (cause is not None and words is not None and cause.text.startswith(words)) == (words is not None)


def test_a_test_that_runs_zero_times_is_reported() -> None:
    run = NodeRun("rate", 0, collected=2, passed=1, skipped=1)
    above = "import pytest\n\n\n@pytest.mark.parametrize('x', {})\n"
    cause = left_out(run, code("    assert bench.heard", above.format("[]")))
    assert cause is not None
    assert cause.text == "parametrize has no values here, so pytest skips the test."
    assert cause.where is not None
    assert cause.where.line == 4
    other = left_out(run, code("    assert bench.heard", above.format("[1.0]")))
    assert other is not None
    assert "parametrize" not in other.text


MARKED = "import pytest\n\n\n@pytest.mark.xfail\n"


@pytest.mark.parametrize(
    ("run", "words", "line"),
    [
        (NodeRun("rate", 0, collected=2, passed=1, skipped=1), "pytest ignores the failure of 1 test, because of", 4),
        (NodeRun("rate", 0, collected=2, passed=2), None, None),
        (
            NodeRun("rate", 0, collected=2, passed=1, test="test_it"),
            "A test failed on this node, but pytest ended",
            None,
        ),
        (NodeRun("rate", 0, collected=1, passed=1), "pytest runs only 1 of the 2 tests in the files.", None),
    ],
)
def test_a_test_that_did_not_count_is_reported(run: NodeRun, words: str | None, line: int | None) -> None:
    two = f"{MARKED}def test_other(bench):\n    assert bench.heard\n\n\n"
    cause = left_out(run, code("    assert bench.heard", two))
    assert (cause and cause.where and cause.where.line) == line
    assert (cause is not None and words is not None and cause.text.startswith(words)) == (words is not None)
