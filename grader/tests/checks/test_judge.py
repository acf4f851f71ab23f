from __future__ import annotations

import random
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.judge import judge, judge_so_far
from grader.checks.kinds import KINDS
from grader.checks.outcome import Finding, Outcome, Status
from grader.evidence.evidence import Evidence, Fault, Run
from grader.report.report import Report
from grader.tests.checks.made import BUILD, NODE_FILE, evidence, exercise, good, node, recording, submission
from grader.tests.checks.shapes import SHAPES
from grader.trial.recording import Command, Output

if TYPE_CHECKING:
    from grader.checks.kind import Kind

NO_BUILD = replace(BUILD, exit_code=1, executables=(), entry_points={}, installed=())
FULL_DISK = "The disk is full: make room."


def by_id(given: Evidence) -> dict[str, Outcome]:
    return {outcome.id: outcome for outcome in judge(given)}


def report(outcomes: tuple[Outcome, ...]) -> Report:
    return Report("03", "Draw a circle", "alice", "", "0", "jazzy", "simulated", "", None, outcomes)


def test_a_good_submission_gets_all_points_and_exit_code_0() -> None:
    made = report(judge(evidence(good())))
    assert (made.points, made.max, made.exit_code) == (100.0, 100.0, 0)


@pytest.mark.parametrize(
    ("shape", "points"),
    [
        ("clockwise", 55.0),
        ("radius 2.2", 55.0),
        ("one hertz", 80.0),
        ("three quarters", 55.0),
        ("beside its place", 55.0),
        ("ignores Ctrl-C", 95.0),
        ("other name", 95.0),
        ("no messages", 15.0),
        ("crash at the start", 0.0),
        ("all zero", 50.0),
        ("late", 80.0),
    ],
)
def test_a_wrong_node_gets_the_points_of_the_checks_that_passed(shape: str, points: float) -> None:
    made = report(judge(evidence(SHAPES[shape]())))
    assert (made.points, made.exit_code) == (points, 1)


def test_what_needs_a_failed_check_is_skipped_and_names_the_first_cause() -> None:
    outcomes = by_id(evidence(None, build=NO_BUILD))
    skipped = [outcome for outcome in outcomes.values() if outcome.status is Status.SKIPPED]
    assert {outcome.id for outcome in skipped} == {
        "installed", "entry-point", "start", "node-name", "topic", "type", "rate", "values", "circle", "wall", "stop",
    }  # fmt: skip
    assert {outcome.finding.observed for outcome in skipped} == {
        'Not judged, because "colcon builds and installs the package" did not pass.'
    }


def test_a_missing_dependency_warns_and_blocks_nothing() -> None:
    text = submission().files["package.xml"].replace(b"  <depend>turtlesim</depend>\n", b"")
    made = report(judge(evidence(good(), submission({"package.xml": text}))))
    assert [outcome.id for outcome in made.with_status(Status.FAILED)] == ["dependencies"]
    assert [outcome.id for outcome in made.warnings] == ["dependencies"]
    assert (made.points, made.exit_code) == (100.0, 0)


def test_advice_that_was_not_followed_fails_no_run() -> None:
    text = submission().files[NODE_FILE].replace(b"create_timer", b"my_timer")
    outcomes = judge(evidence(good(), submission({NODE_FILE: text})))
    (timer,) = [outcome for outcome in outcomes if outcome.advice]
    assert timer.status is Status.FAILED
    assert report(outcomes).exit_code == 0
    assert report(outcomes).with_status(Status.FAILED) == ()


@pytest.mark.parametrize(
    ("given", "broken", "points"),
    [
        (evidence(None, build=None, fault=Fault("build", FULL_DISK)), 12, 0.0),
        (evidence(None, fault=Fault("trial", FULL_DISK)), 9, 0.0),
    ],
)
def test_a_fault_of_the_machine_takes_nothing_out_of_the_maximum(given: Evidence, broken: int, points: float) -> None:
    made = report(judge(given))
    errors = made.with_status(Status.ERROR)
    assert (len(errors), {outcome.finding.observed for outcome in errors}) == (broken, {FULL_DISK})
    assert (made.points, made.max, made.exit_code) == (points, 100.0, 3)
    assert made.with_status(Status.SKIPPED) == ()


def test_what_is_missing_is_the_build_or_the_trial() -> None:
    outcomes = by_id(evidence(None, build=None))
    assert outcomes["build"].finding.observed == "Not judged, because the package was not built."
    assert by_id(evidence(None))["start"].finding.observed == "Not judged, because its trial was not run."


def test_a_students_fault_before_the_machines_is_reported_as_the_students() -> None:
    no_module = replace(BUILD, entry_points={"draw_circle": "my_robot_controller.other:main"})
    outcomes = by_id(evidence(None, build=no_module, fault=Fault("trial", FULL_DISK)))
    assert outcomes["entry-point"].status is Status.FAILED
    assert outcomes["circle"].status is Status.SKIPPED


def test_an_exception_in_a_check_is_reported_as_unreadable_and_the_others_are_judged(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def broken(*_: object) -> Finding:
        raise ZeroDivisionError

    monkeypatch.setattr("grader.checks.judge.KINDS", {**KINDS, "values": replace(KINDS["values"], check=broken)})
    outcomes = by_id(evidence(good()))
    assert outcomes["values"].status is Status.FAILED
    assert outcomes["values"].finding.diagnosis == "unreadable"
    assert "could not be read: ZeroDivisionError" in outcomes["values"].finding.observed
    expected = "The grader can read the submitted files and the data that the node sends."
    words = (
        "Very large, deeply nested or damaged content can cause this. If your submission contains nothing of this kind,"
    )
    assert {id_ for id_, each in outcomes.items() if each.finding.expected == expected} == {"values"}
    assert {id_ for id_, each in outcomes.items() if each.finding.cause.startswith(words)} == {"values"}
    assert words not in by_id(evidence(None))["values"].finding.cause
    assert [outcome.id for outcome in outcomes.values() if outcome.status is not Status.PASSED] == ["values"]


def test_a_trial_is_wanted_only_where_it_would_be_judged() -> None:
    assert judge_so_far(evidence(None), {}).wants("circle")
    assert not judge_so_far(evidence(None, build=NO_BUILD), {}).wants("circle")


def test_a_settled_finding_stands_and_the_others_follow_the_new_evidence(monkeypatch: pytest.MonkeyPatch) -> None:
    run: list[str] = []

    def counted(kind: Kind[Any]) -> Kind[Any]:
        def check(given: Evidence, params: object) -> Finding:
            run.append(kind.name)
            return kind.check(given, params)

        return replace(kind, check=check)

    monkeypatch.setattr("grader.checks.judge.KINDS", {name: counted(kind) for name, kind in KINDS.items()})
    before = judge_so_far(evidence(None), {})
    assert run
    after = judge_so_far(evidence(good()), before.settled)
    assert len(run) == len(exercise().checks)
    assert after.outcomes == judge(evidence(good()))
    assert set(after.settled) == {spec.id for spec in exercise().checks}


def test_what_the_machine_could_not_judge_is_judged_again() -> None:
    broken = judge_so_far(evidence(None, fault=Fault("trial", FULL_DISK)), {})
    assert judge_so_far(evidence(good()), broken.settled).outcomes == judge(evidence(good()))


@pytest.mark.parametrize("shape", sorted(SHAPES))
def test_the_same_evidence_gives_the_same_findings_in_any_order(shape: str) -> None:
    made = SHAPES[shape]()
    first = by_id(evidence(made))
    checks = list(exercise().checks)
    random.Random(shape).shuffle(checks)
    again = by_id(evidence(made, exercise=replace(exercise(), checks=tuple(checks))))
    assert again == first
    assert [outcome for outcome in first.values() if outcome.status is Status.ERROR] == []


ANY = st.floats(allow_nan=True, allow_infinity=True)
COMMANDS = st.builds(
    Command,
    t_s=st.floats(-1.0, 12.0),
    mono_s=st.just(0.0),
    linear=st.tuples(ANY, ANY, ANY),
    angular=st.tuples(ANY, ANY, ANY),
)


@given(st.lists(COMMANDS, max_size=12), st.text(max_size=200))
def test_whatever_a_student_sends_is_never_the_graders_fault(commands: list[Command], text: str) -> None:
    given_ = sorted(commands, key=lambda command: command.t_s)
    outcomes = judge(evidence(recording(given_, stderr=Output(text), stdout=Output(text))))
    assert [outcome for outcome in outcomes if outcome.status is Status.ERROR] == []


@given(st.dictionaries(st.sampled_from(["package.xml", "setup.py", NODE_FILE, "setup.cfg"]), st.binary(max_size=200)))
def test_whatever_a_student_hands_in_is_never_the_graders_fault(files: dict[str, bytes]) -> None:
    outcomes = judge(evidence(good(), submission(files)))
    assert [outcome for outcome in outcomes if outcome.status is Status.ERROR] == []


def test_a_node_that_brings_the_simulator_down_has_failed_and_is_no_error() -> None:
    given = evidence(None).with_run(Run(overwhelmed="MemoryError"))
    made = report(judge(given))
    assert (made.points, made.max, made.exit_code) == (0.0, 100.0, 1)
    (start,) = [outcome for outcome in made.outcomes if outcome.id == "start"]
    assert (start.finding.diagnosis, "MemoryError" in start.finding.observed) == ("overwhelmed", True)
    words = (
        "The node sends without a pause, or sends invalid data. If your node pauses and sends valid data, please report"
    )
    assert start.finding.cause.startswith(words)
    assert words not in by_id(evidence(good()))["start"].finding.cause


@pytest.mark.parametrize(("period", "found"), [("0.5", False), ("0.0", True), ("1 // 2", True)])
def test_a_timer_that_brings_the_simulator_down_is_pointed_at(period: str, *, found: bool) -> None:
    given = evidence(None, node(("create_timer(0.5,", f"create_timer({period},"))).with_run(Run(overwhelmed="busy"))
    start = by_id(given)["start"].finding
    words = "The period of this timer is 0 s, so it calls its method without a pause."
    assert (start.cause == words, str(start.where)) == (found, f"{NODE_FILE}:10" if found else "None")
