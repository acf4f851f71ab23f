"""Causes are confirmed by testing a fix. The tests use invented runs."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.cause import Cause
from grader.checks.edit import Edit
from grader.checks.outcome import Finding, Outcome, Status, failed, passed
from grader.evidence.evidence import Evidence
from grader.evidence.tries import Tries, Try
from grader.grading.explain import BARE_NODE_S, ENOUGH, MOST_TRIES, NOT_SIMULATED, TOO_LONG, explain, part_of
from grader.grading.grade import grade
from grader.grading.options import Options
from grader.report.report import FURTHER, PASSES, REFUTED, report_of
from grader.sandbox import bubblewrap
from grader.submission.package import open_submission
from grader.submission.where import Where
from grader.tests.case import CASES, make_submission, read_case
from grader.tests.checks.made import NODE_FILE, exercise, submission

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from grader.checks.diagnosis import Diagnosis
    from grader.exercise.model import Exercise
    from grader.submission.package import Submission

LONG_S = 1000.0
RIGHT = "right"


def wrong(id_: str, diagnosis: Diagnosis = "crash", line: int = 1, old: str = "a", new: str = RIGHT) -> Outcome:
    fix = (Edit(NODE_FILE, line, old, new),) if new else ()
    cause = Cause(diagnosis, "It is so.", Where(NODE_FILE, line), fix)
    return Outcome(id_, "values", id_, 0.0, 5.0, failed("It fails.", "It passes.", cause))


def right(id_: str) -> Outcome:
    return Outcome(id_, "values", id_, 5.0, 5.0, passed("It passes."))


def tries(
    source: str, judged: Callable[[str], Sequence[Outcome]], build_s: float = LONG_S
) -> tuple[Tries, dict[str, Outcome]]:
    """Return the changes that were tested for this source code, and the reported outcomes.

    `judged` is a function that returns invented outcomes for given source code.
    """
    evidence = Evidence(exercise(), submission({NODE_FILE: source}))
    outcomes = tuple(judged(source))

    def regrade(_: Exercise, copy: Submission) -> Sequence[Outcome]:
        return judged(copy.files[NODE_FILE].decode())

    found = explain(evidence, outcomes, build_s, regrade)
    reported = report_of(Evidence(exercise(), evidence.submission, tries=found), outcomes, "", {})
    return found, {outcome.id: outcome for outcome in reported.outcomes}


def test_a_cause_whose_fix_makes_the_check_pass_is_confirmed() -> None:
    found, reported = tries("a\n", lambda text: [right("values") if RIGHT in text else wrong("values")])
    assert [each.result for each in found.made] == ["passes"]
    assert reported["values"].finding.tried == PASSES
    assert "+right" in found.made[0].difference


def test_a_student_sees_the_change_only_where_the_exercise_shows_it() -> None:
    found, _ = tries("a\n", lambda text: [right("values") if RIGHT in text else wrong("values")])
    shown = replace(exercise(), show_fix=True)
    for given, expected in ((exercise(), PASSES), (shown, f"{PASSES} The change: remove a; write {RIGHT}")):
        evidence = Evidence(given, submission({NODE_FILE: "a\n"}), tries=found)
        reported = report_of(evidence, (wrong("values"),), "", {}).outcomes[0]
        assert reported.finding.tried == expected


def test_a_cause_that_changes_nothing_is_refuted_and_not_reported() -> None:
    found, reported = tries("a\n", lambda _: [wrong("values")])
    assert [each.result for each in found.made] == ["refuted"]
    assert (reported["values"].finding.cause, reported["values"].finding.tried) == ("", REFUTED)


def test_a_change_that_breaks_another_check_confirms_nothing() -> None:
    def judged(text: str) -> list[Outcome]:
        return [wrong("values"), right("rate")] if RIGHT not in text else [wrong("values", line=2), wrong("rate")]

    assert tries("a\na\n", judged)[0].made[0].result == "refuted"


def test_mistakes_behind_a_mistake_are_counted_and_confirmed_in_turn() -> None:
    def judged(text: str) -> list[Outcome]:
        at = next((line for line, part in enumerate(text.split(), 1) if part == "a"), 0)
        return [wrong("start", line=at) if at else right("start")]

    found, reported = tries("a\na\na\n", judged)
    assert [each.result for each in found.made] == ["further", "further", "passes"]
    assert found.behind == 2
    assert reported["start"].finding.tried == f"{FURTHER} After this fix, 2 more mistakes appeared."


def test_a_mistake_behind_a_mistake_counts_once_if_several_checks_fail() -> None:
    def judged(text: str) -> list[Outcome]:
        first, second = (part == RIGHT for part in text.split())
        if not first:
            skipped = Finding(Status.SKIPPED, "Not judged.")
            return [wrong("start"), *(Outcome(id_, "values", id_, 0.0, 5.0, skipped) for id_ in ("topic", "stop"))]
        return [right("start"), *(right(id_) if second else wrong(id_, line=2) for id_ in ("topic", "stop"))]

    found, reported = tries("a\na\n", judged)
    assert [(each.check, each.result) for each in found.made] == [("start", "passes"), ("topic", "passes")]
    assert reported["start"].finding.tried == f"{PASSES} After this fix, 1 more mistake appeared."


def test_a_cause_of_several_checks_is_tried_once() -> None:
    def judged(text: str) -> list[Outcome]:
        return [right(id_) if RIGHT in text else wrong(id_) for id_ in ("topic", "stop")]

    found, reported = tries("a\n", judged)
    assert [(each.check, each.result) for each in found.made] == [("topic", "passes"), ("stop", "passes")]
    assert {outcome.finding.tried for outcome in reported.values()} == {PASSES}


@pytest.mark.parametrize("change", [{"new": ""}, {"old": "not there"}])
def test_a_cause_without_a_change_that_fits_is_reported_as_it_was(change: Mapping[str, str]) -> None:
    found, reported = tries("a\n", lambda _: [wrong("values", **change)])  # type: ignore[arg-type]
    assert (found, reported["values"].finding.cause, reported["values"].finding.tried) == (Tries(), "It is so.", "")


def test_a_try_that_could_not_be_judged_says_nothing() -> None:
    broken = Outcome("values", "values", "values", 0.0, 5.0, Finding(Status.ERROR, "The machine."))
    found, reported = tries("a\n", lambda text: [broken if RIGHT in text else wrong("values")])
    assert found == Tries(stopped=NOT_SIMULATED)
    assert (reported["values"].finding.cause, reported["values"].finding.tried) == ("It is so.", "")


def test_no_more_than_some_changes_are_tried() -> None:
    names = [spec.id for spec in exercise().checks][: MOST_TRIES + 2]
    found, _ = tries("a\n" * len(names), lambda _: [wrong(name, line=line) for line, name in enumerate(names, 1)])
    assert (len(found.made), found.stopped) == (MOST_TRIES, ENOUGH)


def test_causes_of_several_checks_do_not_change_how_many_are_tried() -> None:
    names = [spec.id for spec in exercise().checks][: 2 * MOST_TRIES + 3]
    lines = {name: (place + 1) // 2 + 1 for place, name in enumerate(names)}  # the first cause is that of one check
    tested = []

    def judged(text: str) -> list[Outcome]:
        tested.append(text)
        done = [line == RIGHT for line in text.split()]
        return [right(name) if done[line - 1] else wrong(name, line=line) for name, line in lines.items()]

    found, _ = tries("a\n" * len(names), judged)
    assert (len(tested) - 1, found.stopped) == (MOST_TRIES, ENOUGH)


def test_without_time_nothing_is_tried() -> None:
    found, _ = tries("a\n", lambda _: [wrong("values")], build_s=-BARE_NODE_S - 1.0)
    assert found == Tries(stopped=TOO_LONG)


def test_a_wrong_topic_is_confirmed_by_a_run_in_the_cell(tmp_path: Path) -> None:
    case = read_case(CASES.parent / "mistakes" / "324-topic-without-turtle")
    options = Options(bubblewrap.usable(), clock="simulated", explain=True)
    graded = grade(exercise(), open_submission(make_submission(case, tmp_path / "in")), options)
    topic = next(outcome for outcome in graded.report.outcomes if outcome.id == "topic").finding
    # The machine is so slow that there is no time for testing a change. The report must say so.
    assert topic.tried == PASSES or graded.evidence.tries.stopped == TOO_LONG
    assert "/turtle1/cmd_vel" not in topic.cause + topic.tried


def test_only_the_trial_of_the_check_is_run_again() -> None:
    part = part_of(exercise(), "values")
    assert [trial.id for trial in part.trials] == ["circle"]
    assert {"values", "topic", "start", "entry-point", "build"} <= {check.id for check in part.checks}


def test_a_try_is_about_one_check_and_one_diagnosis() -> None:
    made = Try("values", "crash", "passes", "")
    assert Tries((made,)).of("values", "crash") is made
    assert Tries((made,)).of("values", "wrong-value") is None
