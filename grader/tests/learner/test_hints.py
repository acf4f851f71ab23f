from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
from typer.testing import CliRunner

from grader.checks.exercises import find_exercise
from grader.cli import app
from grader.errors import UsageError
from grader.exercise.model import catalogue
from grader.learner import hints, progress, steps

if TYPE_CHECKING:
    from pathlib import Path

    from grader.exercise.model import Exercise

LAST = "07-challenges"


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Create a learner with a separate progress file."""
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.delenv("XDG_STATE_HOME", raising=False)
    monkeypatch.delenv("ROS2_WORKSPACE", raising=False)
    return tmp_path


def verdict(step: str, *, failed: tuple[str, ...] = (), done: tuple[str, ...] = (), passed: bool = False) -> None:
    """Store a report in the learner's progress."""

    def change(before: progress.Progress) -> progress.Progress:
        known = replace(before.step(step), failed=failed, done=done, passed=passed)
        return before.at(step).with_step(step, known)

    progress.update(progress.workspace_of(None), change)


def texts(step: str, check: str) -> list[str]:
    """Return the hints for a check."""
    return [" ".join(hint.text.split()) for hint in find_exercise(step).hints if check in hint.checks]


def checks_of(step: str, part: str) -> tuple[str, ...]:
    """Return the ids of the checks of a part."""
    return tuple(check.id for check in find_exercise(step).checks if check.title.startswith(f"{part})"))


def all_texts(step: str) -> list[str]:
    return [" ".join(hint.text.split()) for hint in find_exercise(step).hints]


def test_before_the_first_verdict_hints_come_in_order_and_the_last_one_repeats() -> None:
    begun = steps.start("01", None)
    given = begun.exercise.hints
    for index, reported in enumerate(hints.hint(None, None) for _ in range(len(given) + 2)):
        assert reported.startswith(f"Hint {min(index + 1, len(given))} of {len(given)}: ")
        assert reported.endswith(" ".join(given[min(index, len(given) - 1)].text.split()))


@pytest.mark.parametrize("check", ["topic", "values", "rate", "wall", "timer"])
def test_after_a_verdict_a_hint_for_a_failed_check_comes_first(check: str) -> None:
    verdict("03-circle-publisher", failed=(check,))
    helps = texts("03-circle-publisher", check)
    for text in helps:
        reported = hints.hint(None, None)
        assert reported.endswith(text)
        assert ', for "' in reported
    others = [text for text in all_texts("03") if text not in helps]
    assert hints.hint(None, None).endswith(others[0])


def test_the_first_failed_check_comes_first() -> None:
    verdict(LAST, failed=("goal", "square"))
    assert [hints.hint(None, None)[-40:] for _ in range(2)] == [
        text[-40:] for text in (*texts(LAST, "goal"), *texts(LAST, "square"))
    ]


def test_after_all_hints_one_for_a_failed_check_is_repeated() -> None:
    verdict(LAST, failed=("square",))
    for _ in find_exercise(LAST).hints:
        hints.hint(None, None)
    assert hints.hint(None, None).endswith(texts(LAST, "square")[-1])


def test_passed_checks_get_no_hint() -> None:
    verdict("04-package-files", done=("depends-rclpy", "depends-geometry-msgs"), failed=("entry-point",))
    reported = {hints.hint(None, None).split(": ", 1)[1] for _ in range(9)}
    done = "each package that they import must be installed when the node runs."
    assert reported == {text for text in all_texts("04") if not text.endswith(done)}
    verdict("04-package-files", passed=True)
    assert hints.hint(None, None) == "04-package-files has passed, so you do not need more hints."


def test_a_step_is_not_said_to_have_passed_if_a_check_without_hints_has_not() -> None:
    helped = {check for hint in find_exercise("04").hints for check in hint.checks}
    verdict("04-package-files", done=tuple(helped))
    assert hints.hint(None, None) == (
        "04-package-files has no hints for the checks that have not passed. `grader check` shows these checks."
    )


@pytest.mark.parametrize("words", [("07", "d"), ("7", "D"), ("07", "d)"), ("d",)])
def test_a_part_has_hints_of_its_own(words: tuple[str, ...]) -> None:
    verdict(LAST, failed=("rate",))
    reported = CliRunner().invoke(app, ["hint", *words]).stdout
    assert reported.startswith("Hint 1 of 1: d) ")


def test_a_passed_step_in_which_a_check_without_hints_fails_again_is_not_called_passed() -> None:
    step = find_exercise("04-package-files")
    hinted = tuple(check for hint in step.hints for check in hint.checks)
    verdict("04-package-files", passed=True, done=hinted, failed=("another",))
    assert hints.hint(None, None).startswith("04-package-files has no hints for the checks that have not passed.")


def test_a_part_that_has_passed_needs_no_hint() -> None:
    verdict(LAST, done=checks_of(LAST, "d"), failed=("square",))
    assert hints.hint("07", None, "d") == "Part d) of 07-challenges has passed, so you do not need more hints."


@pytest.mark.parametrize("failed", [("goal-stop",), ()], ids=["failed", "skipped-or-error"])
def test_a_part_in_which_only_a_check_without_hints_has_not_passed_is_not_called_passed(
    failed: tuple[str, ...],
) -> None:
    done = tuple(check for check in checks_of(LAST, "d") if check != "goal-stop")
    verdict(LAST, done=done, failed=failed)
    assert hints.hint("07", None, "d") == (
        "Part d) of 07-challenges has no hints for the checks that have not passed. `grader check` shows these checks."
    )


def test_a_part_has_passed_even_if_its_advice_did_not(monkeypatch: pytest.MonkeyPatch) -> None:
    def exercise_with_advice(step: str, *, outline: bool) -> Exercise:
        exercise = find_exercise(step, outline=outline)
        checks = (replace(each, kind="uses_timer") if each.id == "goal-stop" else each for each in exercise.checks)
        return replace(exercise, checks=tuple(checks))

    monkeypatch.setattr(hints, "find_exercise", exercise_with_advice)
    verdict(LAST, done=tuple(check for check in checks_of(LAST, "d") if check != "goal-stop"))
    assert hints.hint("07", None, "d") == "Part d) of 07-challenges has passed, so you do not need more hints."


def test_a_part_of_a_passed_step_stays_passed_after_an_error() -> None:
    verdict(LAST, passed=True, done=())
    assert hints.hint("07", None, "d") == "Part d) of 07-challenges has passed, so you do not need more hints."


@pytest.mark.parametrize(("failed", "part"), [("catches", "b"), ("random", "a")])
def test_a_passed_part_gets_no_hint_because_of_a_later_part_that_was_not_judged(failed: str, part: str) -> None:
    of_a = ("dependencies", "catcher-entry-point", *checks_of("13", "a"))
    of_b = ("catcher-start", "catches", "order", "reach")
    verdict("13-catch-them-all", done=(*of_a, *(of_b if failed == "random" else ())), failed=(failed,))
    for _ in range(9):
        assert not hints.hint(None, None).split(": ", 1)[1].startswith("a) ") or part == "a"
    if part == "b":
        assert hints.hint("13", None, "a").endswith("has passed, so you do not need more hints.")
    else:
        assert "a) call_async sends the request" in hints.hint("13", None, "a")


def test_an_unknown_part_is_an_error_that_lists_the_parts() -> None:
    with pytest.raises(UsageError, match=r"'e' is not a part of 07-challenges, which has the parts a, b, c and d\."):
        hints.hint("07", None, "e")
    with pytest.raises(UsageError, match="'a' is not a part of 03-circle-publisher, which has no parts"):
        hints.hint("03", None, "a")
    exercise = find_exercise("07")
    only_a = replace(exercise, hints=tuple(each for each in exercise.hints if each.part == "a"))
    with pytest.raises(UsageError, match=r"which has the part a\."):
        hints._part(only_a, "e")


def test_hints_without_a_step_say_how_to_start_one() -> None:
    with pytest.raises(UsageError, match="grader start 01"):
        hints.hint(None, None)


@pytest.mark.parametrize("step", list(catalogue()))
def test_every_check_that_a_starting_point_fails_has_a_hint(step: str) -> None:
    assert all(texts(step, check) for check in find_exercise(step).unsolved)
