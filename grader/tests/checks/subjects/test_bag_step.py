"""The checks of bags, functions and programs, with made-up results and bags."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise
from grader.checks.kinds import KINDS
from grader.checks.outcome import Status
from grader.evidence.evidence import Evidence, Run
from grader.submission.package import open_submission
from grader.tests import made_bag
from grader.tests.case import ROOT
from grader.trial.called import TOO_LATE, Called

if TYPE_CHECKING:
    from pathlib import Path

    from grader.checks.outcome import Finding
    from grader.submission.package import Submission
    from grader.trial.recording import Message

EXERCISE = find_exercise("11-bags")
SPECS = {spec.id: spec for spec in EXERCISE.checks}
X, Y, RADIUS = 5.5, 7.25, 1.75
"""The circle from which the points of the call "whole" are drawn."""
C = RADIUS**2 - X**2 - Y**2


@cache
def solution() -> Submission:
    return open_submission(ROOT / "solutions/11-bags")


def judged(check: str, called: Called | None = None, files: dict[str, bytes] | None = None) -> Finding:
    """Return the finding of one check on this result of a call, or on the solution with these files added."""
    spec = SPECS[check]
    files = files or {}
    bag = any(path.startswith("circle_bag/") for path in files)
    kept = {path: data for path, data in solution().files.items() if not (bag and path.startswith("circle_bag/"))}
    submission = replace(solution(), files={**kept, **files})
    runs = {spec.trial: Run(called=(called,))} if called is not None else {}
    evidence = Evidence(EXERCISE, submission, runs=runs).from_trial(spec.trial)
    return KINDS[spec.kind].judge(evidence, spec.params)


def returned(*values: float, kind: str = "tuple") -> Called:
    return Called("whole", "exit 0", values=values, kind=kind)


def raised(id_: str, error: str, classes: str = "") -> Called:
    lines = ("Traceback (most recent call last):", '  File "my_robot_controller/circle_fit.py", line 9, in f', error)
    return Called(id_, "exit 1", stderr="\n".join(lines), kind=classes)


def printed(line: str, id_: str = "slow") -> Called:
    return Called(id_, "exit 0", stdout=f"{line}\n")


@pytest.mark.parametrize(
    ("called", "diagnosis"),
    [
        (returned(X, Y, RADIUS), None),
        (returned(Y, X, RADIUS), "x-y-swapped"),
        (returned(RADIUS, X, Y), "result-order"),
        (returned(X, Y, RADIUS**2), "radius-squared"),
        (returned(X, Y, 2 * RADIUS), "diameter"),
        (returned(X, Y, C), "radius-without-centre"),
        (returned(X, Y, math.sqrt(-C)), "radius-without-centre"),
        (returned(X, Y, math.nan), "radius-without-centre"),
        (returned(math.nan, Y, RADIUS), "not-a-number"),
        (returned(2 * X, 2 * Y, 9.0), "centre-doubled"),
        (returned(-X, -Y, RADIUS), "centre-sign"),
        (returned(0.0, 0.0, 0.0), "wrong-fit"),
        (returned(X, Y, RADIUS + 0.01), "wrong-fit"),
        (returned(X, Y), "result-form"),
        (Called("whole", "exit 0", kind="NoneType"), "result-form"),
        (Called("whole", TOO_LATE), "call-too-long"),
        (Called("whole", "exit 1", stderr="the end\n"), "call-ended"),
        (Called("whole"), "call-ended"),
        (raised("whole", "ValueError: too many values to unpack (expected 3)"), "lstsq-result"),
        (raised("whole", "ZeroDivisionError: division by zero"), "crash"),
    ],
)
def test_what_a_fit_returned_has_a_cause(called: Called, diagnosis: str | None) -> None:
    assert judged("whole", called).diagnosis == diagnosis


@pytest.mark.parametrize(
    ("values", "diagnosis"),
    [
        ((6.430, 6.440, 1.538), "mean-for-centre"),
        ((6.263, 6.017, 2.555), "extremes-for-centre"),
        ((6.001, 4.002, 2.998), None),
    ],
)
def test_an_arc_shows_what_is_taken_for_its_centre(values: tuple[float, ...], diagnosis: str | None) -> None:
    assert judged("arc", replace(returned(*values), id="arc")).diagnosis == diagnosis


@pytest.mark.parametrize(
    ("called", "diagnosis"),
    [
        (raised("too-few", "ValueError: too few", "ValueError Exception"), None),
        (raised("too-few", "numpy.linalg.LinAlgError: singular", "LinAlgError ValueError Exception"), None),
        (raised("too-few", "RuntimeError: too few", "RuntimeError Exception"), "other-error"),
        (Called("too-few", "exit 1"), "other-error"),
        (Called("too-few", "exit 0", kind="NoneType"), "no-error"),
        (Called("too-few", TOO_LATE), "call-too-long"),
    ],
)
def test_two_points_are_refused(called: Called, diagnosis: str | None) -> None:
    assert judged("too-few", called).diagnosis == diagnosis


@pytest.mark.parametrize(
    ("line", "diagnosis"),
    [
        ("messages=21 rate=2.00 x=4.20 y=6.90 radius=1.80", None),
        ("messages=21 rate=2.10 x=4.20 y=6.90 radius=1.80", "rate-off-by-one"),
        ("messages=21 rate=0.00 x=4.20 y=6.90 radius=1.80", "nanoseconds"),
        ("messages=21 rate=0.50 x=4.20 y=6.90 radius=1.80", "period-for-rate"),
        ("messages=21 rate=9.00 x=4.20 y=6.90 radius=1.80", "wrong-rate"),
        ("messages=20 rate=2.00 x=4.20 y=6.90 radius=1.80", "wrong-count"),
        ("messages=21 rate=2.00 x=6.90 y=4.20 radius=1.80", "x-y-swapped"),
        ("messages=21 rate=2.00 x=4.20 y=6.90 radius=3.60", "diameter"),
        ("messages=21 rate=2.00 x=4.20 y=6.90 radius=nan", "not-a-number"),
        ("messages: 21", "print-format"),
        ("", "prints-nothing"),
    ],
)
def test_a_printed_line_has_a_cause(line: str, diagnosis: str | None) -> None:
    assert judged("report", printed(line)).diagnosis == diagnosis


def test_messages_of_other_topics_do_not_count() -> None:
    line = "messages=43 rate=12.50 x=7.30 y=3.10 radius=0.90"
    assert judged("other-topics", printed(line, "two-topics")).diagnosis == "all-messages"
    taken = raised("two-topics", "AttributeError: 'geometry_msgs__msg__Twist' object has no attribute 'x'")
    assert judged("other-topics", taken).diagnosis == "all-messages"


@pytest.mark.parametrize(
    ("called", "diagnosis"),
    [
        (Called("no-poses", "exit 1", stderr="no poses\n"), None),
        (Called("no-poses", "exit 0", stdout="no poses\n"), "exit-code"),
        (Called("no-poses", "exit 1"), "exit-code"),
        (raised("no-poses", "IndexError: list index out of range"), "program-traceback"),
    ],
)
def test_a_bag_without_poses_is_told(called: Called, diagnosis: str | None) -> None:
    assert judged("no-poses", called).diagnosis == diagnosis


@pytest.mark.parametrize(
    ("check", "answer", "diagnosis"),
    [
        ("duration", '"11.1 s"', None),
        ("duration", '"11.12s"', None),
        ("duration", '"11.1"', "unit-missing"),
        ("duration", '"11.1 m"', "wrong-unit"),
        ("duration", '"11123267399 s"', "nanoseconds"),
        ("duration", '"13 s"', "wrong-answer"),
        ("duration", '"long"', "answer-form"),
        ("rate", '"0.016 Hz"', "period-for-rate"),
        ("radius", '"2.2 m"', "diameter"),
        ("messages", "696", None),
        ("messages", '"696"', None),
        ("messages", "695", "wrong-answer"),
        ("messages", "0", "no-answer"),
    ],
)
def test_an_answer_is_a_number_with_its_unit(check: str, answer: str, diagnosis: str | None) -> None:
    files = {"answers.toml": f"[answers]\n{check} = {answer}\n".encode()}
    assert judged(check, files=files).diagnosis == diagnosis


@pytest.mark.parametrize(
    ("check", "messages", "diagnosis"),
    [
        ("bag-circle", made_bag.poses(), None),
        ("bag-circle", made_bag.poses(drive_s=0.0), "bag-still"),
        ("bag-circle", made_bag.poses(drive_s=5.0), "too-short"),
        ("bag-circle", made_bag.poses(1.5, drive_s=13.0), "wrong-radius"),
        ("bag-circle", made_bag.poses(speed=1.0), "wrong-speed"),
        ("bag-circle", [*made_bag.poses(), *made_bag.poses(2.2, drive_s=20.0)], "not-round"),
        ("bag-topic", made_bag.commands(), "bag-topic"),
        ("bag", [], "bag-empty"),
    ],
)
def test_a_bag_has_a_cause(check: str, messages: list[Message], diagnosis: str | None, tmp_path: Path) -> None:
    made_bag.record(tmp_path / "circle_bag", messages)
    files = {f"circle_bag/{file.name}": file.read_bytes() for file in (tmp_path / "circle_bag").iterdir()}
    finding = judged(check, files=files)
    assert (finding.diagnosis, finding.status is Status.PASSED) == (diagnosis, diagnosis is None)
