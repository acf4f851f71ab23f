"""The set-up on a system that lacks programs."""

from __future__ import annotations

import pytest

from grader.common.package_managers import Need
from grader.setup.setup_errors import MACHINE_BROKEN
from grader.tests.setup.course import LEARNER, SYSTEMS, TESTS, Course


def test_what_is_missing_is_reported_and_nothing_is_done(course: Course, capsys: pytest.CaptureFixture[str]) -> None:
    course.needs = [Need("cmake", "cmake")]
    course.python = SYSTEMS._replace(headers=False)
    assert course.set_up() == MACHINE_BROKEN
    assert course.commands == []
    message = capsys.readouterr().err
    assert "Python.h" in message
    assert message.count("apt-get install") == 1


BUBBLEWRAP = Need("bubblewrap, the sandbox", "bubblewrap", "no marks")
CMAKE = Need("cmake", "cmake")
BROWSER, SHELLCHECK = Need("a browser", "chromium", "no pages"), Need("shellcheck", "shellcheck", "no scripts")


def test_what_is_missing_is_installed_and_the_set_up_goes_on(course: Course) -> None:
    course.needs = [CMAKE, BUBBLEWRAP]
    course.granted = {"cmake", "bubblewrap"}
    assert course.set_up() == 0
    assert course.requested == [["cmake", "bubblewrap"]]
    assert course.programs == ["venv", "grader.setup.install"]


def test_a_learner_goes_on_without_a_sandbox_after_a_message(
    course: Course, capsys: pytest.CaptureFixture[str]
) -> None:
    course.needs = [BUBBLEWRAP]
    assert course.set_up() == 0
    assert course.programs == ["venv", "grader.setup.install"]
    (reported,) = [line for line in capsys.readouterr().out.splitlines() if "bubblewrap" in line]
    assert reported.startswith("Without bubblewrap: no marks. It was not installed: not allowed. To install it: ")


def test_what_can_be_done_without_is_tried_for_once_and_reported_each_time(
    course: Course, capsys: pytest.CaptureFixture[str]
) -> None:
    course.needs = [BUBBLEWRAP]
    course.set_up()
    capsys.readouterr()
    assert course.set_up() == 0
    assert course.requested == []
    assert capsys.readouterr().out.count("Without bubblewrap: no marks.") == 1
    course.set_up(TESTS)
    assert course.requested == [["bubblewrap"]]


def test_what_cannot_be_done_without_is_tried_for_each_time(course: Course, capsys: pytest.CaptureFixture[str]) -> None:
    course.set_up()
    course.needs = [CMAKE, BUBBLEWRAP]
    assert course.set_up() == MACHINE_BROKEN
    assert course.requested == [["cmake", "bubblewrap"]]
    assert course.commands == []
    message = capsys.readouterr().err
    assert "  - cmake\n" in message
    assert "The missing parts were not installed: not allowed.\n" in message


def test_the_tests_need_a_sandbox(course: Course) -> None:
    course.needs = [BUBBLEWRAP]
    assert course.set_up(TESTS) == MACHINE_BROKEN
    assert course.commands == []


@pytest.mark.parametrize("granted", [set(), {"chromium", "shellcheck"}])
def test_the_tests_go_on_without_a_browser(
    course: Course, capsys: pytest.CaptureFixture[str], granted: set[str]
) -> None:
    course.of_tests, course.granted = [BROWSER, SHELLCHECK], granted
    assert course.set_up(TESTS) == 0
    assert course.requested == [["chromium", "shellcheck"]]
    reported = [line[: line.index(".")] for line in capsys.readouterr().out.splitlines() if line.startswith("Without")]
    assert reported == ([] if granted else ["Without a browser: no pages", "Without shellcheck: no scripts"])


def test_a_learner_needs_nothing_that_only_tests_need(course: Course, capsys: pytest.CaptureFixture[str]) -> None:
    course.of_tests = [BROWSER]
    assert course.set_up(LEARNER) == 0
    assert course.requested == []
    assert "browser" not in capsys.readouterr().out
