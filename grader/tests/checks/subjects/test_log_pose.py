"""The log lines of step 06, compared with the turtle's trajectory: forward and left, a pause, backward."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

from grader.checks.outcome import Finding, Status
from grader.checks.subjects.log_pose import LOG_DISTANCE, LOG_POSITION
from grader.tests.checks.made import NODE_FILE, evidence, found, frames, legs, node, recording
from grader.tests.checks.told import told
from grader.trial.recording import LogLine

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.checks.kind import Kind
    from grader.trial.recording import Floats, Recording

FORMAT = "x={x:.2f} y={y:.2f} distance={distance:.2f}"
PACKAGE = node(
    ("        msg = Twist()", "        way = math.hypot(1.0, 2.0)\n        self.get_logger().info(f'{way}')")
)
LOGS = {"position": 14, "distance": 13}
"""The lines of this package at which each kind of mistake is reported."""
WAY = legs((40, 1.0, 0.7), (15, 0.0, 0.0), (30, -0.9, 0.5))
DRIVE = recording(WAY)
TIMES = np.arange(1.0, 10.0)

Said = tuple["Floats", "Floats", "Floats"]
"""A log with one line for each x, y and distance."""


def truth(lag_s: float = 0.0) -> Said:
    """Return x, y and the distance (m) that a correct node logs at TIMES, with poses that are `lag_s` (s) old."""
    frames, start = DRIVE.frames, DRIVE.start
    at = np.searchsorted(frames.t_s, TIMES - lag_s) - 1
    x, y = np.append(start.x, frames.x), np.append(start.y, frames.y)
    driven_m = np.cumsum(np.hypot(np.diff(x), np.diff(y)))
    return frames.x[at], frames.y[at], driven_m[at]


def logged(said: Said, stalls: tuple[tuple[float, float], ...] = ()) -> Recording:
    log = tuple(
        LogLine(float(t_s), "INFO", "pose_subscriber", f"x={x:.2f} y={y:.2f} distance={distance:.2f}")
        for t_s, x, y, distance in zip(TIMES, *said, strict=True)
    )
    return recording(WAY, log=log, stalls=stalls)


def position(said: Said) -> Finding:
    return found(LOG_POSITION, evidence(logged(said), PACKAGE), format=FORMAT)


def distance(said: Said) -> Finding:
    return found(LOG_DISTANCE, evidence(logged(said), PACKAGE), format=FORMAT)


@pytest.mark.parametrize("lag_s", [0.0, 0.016, 0.1])
def test_the_truth_is_right_also_when_it_is_a_little_old(lag_s: float) -> None:
    assert position(truth(lag_s)).observed == "Each line shows where the turtle is."
    assert distance(truth(lag_s)).observed == "Each line shows how far the turtle has driven."


def test_what_is_a_second_old_or_half_a_second_ahead_is_wrong() -> None:
    assert position(truth(1.0)).diagnosis == "wrong-position"
    assert position(truth(-0.5)).diagnosis == "wrong-position"


def test_a_line_after_the_last_frame_is_compared_with_the_last_frame() -> None:
    trial = logged(truth())
    short = replace(trial, frames=frames(trial.commands, trial.start, 7.0))
    x, y = short.frames.x[-1], short.frames.y[-1]
    last = replace(trial.log[-1], text=f"x={x:.2f} y={y:.2f} distance=0.00")
    for line, diagnosis in ((last, None), (trial.log[-1], "wrong-position")):
        given = evidence(replace(short, log=(*trial.log[:6], line)))
        assert found(LOG_POSITION, given, format=FORMAT).diagnosis == diagnosis


WRONG: dict[str, tuple[Callable[[Said], Said], str, str]] = {
    "swapped": (lambda t: (t[1], t[0], t[2]), "position", "x-y-swapped"),
    "never renewed": (lambda t: (t[0] * 0 + 5.54, t[1] * 0 + 5.54, t[2]), "position", "stale-pose"),
    "in other units": (lambda t: (100.0 * t[0], 100.0 * t[1], t[2]), "position", "wrong-position"),
    "always 0": (lambda t: (t[0], t[1], t[2] * 0), "distance", "distance-zero"),
    "straight back to the start": (
        lambda t: (t[0], t[1], np.hypot(t[0] - DRIVE.start.x, t[1] - DRIVE.start.y)),
        "distance",
        "distance-from-start",
    ),
    "from place to place": (
        lambda t: (
            t[0],
            t[1],
            np.cumsum(np.hypot(np.diff(t[0], prepend=DRIVE.start.x), np.diff(t[1], prepend=DRIVE.start.y))),
        ),
        "distance",
        "distance-by-chords",
    ),
    "from the corner of the window": (lambda t: (t[0], t[1], np.hypot(t[0], t[1])), "distance", "distance-from-zero"),
    "with a first step from 0, 0": (
        lambda t: (t[0], t[1], t[2] + np.hypot(DRIVE.start.x, DRIVE.start.y)),
        "distance",
        "distance-from-zero",
    ),
    "twice as much": (lambda t: (t[0], t[1], 2.0 * t[2]), "distance", "wrong-distance"),
}


@pytest.mark.parametrize("name", WRONG)
def test_each_other_number_fails_for_its_own_reason(name: str) -> None:
    change, subject, diagnosis = WRONG[name]
    finding = {"position": position, "distance": distance}[subject](change(truth()))
    assert (finding.status, finding.diagnosis) == (Status.FAILED, diagnosis)
    assert str(finding.where) == f"{NODE_FILE}:{LOGS[subject]}"
    assert finding.cause


def test_a_wrong_line_is_reported_with_the_true_values() -> None:
    x, y, driven_m = truth()
    finding = position((x + 1.0, y, driven_m))
    assert finding.observed == (
        f"At 1 s, the line shows x={x[0] + 1.0:.2f} y={y[0]:.2f}, but the turtle was at x={x[0]:.2f} y={y[0]:.2f}."
    )
    finding = distance((x, y, driven_m + np.arange(9.0)))
    assert finding.observed == (
        f"At 9 s, the line shows distance={driven_m[-1] + 8.0:.2f}, but the turtle had driven {driven_m[-1]:.2f} m."
    )


def test_one_wrong_line_is_enough() -> None:
    x, y, driven_m = truth()
    x[4] += 0.5
    assert position((x, y, driven_m)).diagnosis == "wrong-position"


def test_a_line_with_nothing_but_the_distance_is_compared() -> None:
    log = tuple(replace(line, text=f"driven {2.0 * float(line.text[-4:]):.2f}") for line in logged(truth()).log)
    wrong = found(LOG_DISTANCE, evidence(recording(WAY, log=log), PACKAGE), format="driven {distance:.2f}")
    assert wrong.diagnosis == "wrong-distance"


def test_too_few_lines_are_not_compared() -> None:
    trial = logged(truth())
    for kind in (LOG_POSITION, LOG_DISTANCE):
        few = found(kind, evidence(recording(WAY, log=trial.log[:2]), PACKAGE), format=FORMAT)
        assert (few.diagnosis, str(few.where)) == ("too-few-log-lines", f"{NODE_FILE}:14")
        assert few.expected.startswith('The log has at least 3 lines such as "x=0.00 y=0.00')
        enough = found(kind, evidence(recording(WAY, log=trial.log[:3]), PACKAGE), format=FORMAT)
        assert enough.status is Status.PASSED


def test_lines_before_the_first_pose_do_not_mean_that_the_machine_was_busy() -> None:
    made = evidence(recording(WAY, log=logged(truth()).log[:4]), PACKAGE)
    late = replace(made.trial, scenario=replace(made.trial.scenario, pose_from_s=3.5))
    given = replace(made, exercise=replace(made.exercise, trials=(late, *made.exercise.trials[1:])))
    assert found(LOG_DISTANCE, given, format=FORMAT).diagnosis == "too-few-log-lines"


def test_what_is_off_by_less_than_the_tolerance_is_right() -> None:
    x, y, driven_m = truth()
    assert position((x + 0.01, y, driven_m)).status is Status.PASSED
    assert position((x + 0.08, y, driven_m)).status is Status.FAILED
    assert distance((x, y, driven_m + 0.03)).status is Status.PASSED
    assert distance((x, y, driven_m + 0.12)).status is Status.FAILED


def test_a_trajectory_that_is_nearly_another_one_is_only_wrong() -> None:
    x, y, driven_m = truth()
    chords = np.cumsum(np.hypot(np.diff(x, prepend=DRIVE.start.x), np.diff(y, prepend=DRIVE.start.y)))
    assert distance((x, y, chords * 1.2)).diagnosis == "wrong-distance"
    assert (
        distance((x, y, driven_m + np.hypot(DRIVE.start.x, DRIVE.start.y) + np.linspace(0.7, 1.3, 9))).diagnosis
        == "wrong-distance"
    )
    assert distance((x, y, np.minimum(driven_m, driven_m[2]))).diagnosis == "wrong-distance"


def test_the_worst_line_is_shown() -> None:
    x, y, driven_m = truth()
    off = driven_m.copy()
    off[3] -= 0.5
    off[6] += 0.4
    assert distance((x, y, off)).observed.startswith("At 4 s, the line shows")


def test_a_line_with_numbers_before_the_first_pose_is_named() -> None:
    early = LogLine(-0.5, "INFO", "pose_subscriber", "x=9.00 y=9.00 distance=9.00")
    trial = recording(WAY, log=(early, *logged(truth()).log))
    finding = found(LOG_POSITION, evidence(trial), format=FORMAT)
    assert (finding.status, finding.diagnosis) == (Status.FAILED, "before-first-pose")
    words = "A line with numbers was logged before the first pose arrived."
    assert finding.observed == words
    late = LogLine(99.0, "INFO", "pose_subscriber", "x=9.00 y=9.00 distance=9.00")
    after = found(LOG_POSITION, evidence(recording(WAY, log=(*logged(truth()).log, late))), format=FORMAT)
    assert after.observed != words
    assert (after.status, "At 99 s" in after.observed) in ((Status.FAILED, True), (Status.PASSED, False))


def test_lines_that_a_stall_delayed_do_not_count_and_without_others_nobody_is_blamed() -> None:
    x, y, driven_m = truth()
    x[4] += 0.5
    stalled = logged((x, y, driven_m), stalls=((4.9, 5.1),))
    assert found(LOG_POSITION, evidence(stalled), format=FORMAT).status is Status.PASSED
    all_of_it = logged((x, y, driven_m), stalls=((0.0, 10.0),))
    assert found(LOG_POSITION, evidence(all_of_it), format=FORMAT).status is Status.ERROR
    silent = replace(all_of_it, log=())
    assert found(LOG_POSITION, evidence(silent), format=FORMAT).status is Status.FAILED


def about(kind: Kind[Any], trial: Recording, source: str = "") -> str:
    package = node(("        msg = Twist()", f"        {source or 'pass'}\n        msg = Twist()"))
    return told(found(kind, evidence(trial, package), format=FORMAT))


X, Y, DRIVEN = truth()
ZERO, CHORDS = (X, Y, DRIVEN * 0), WRONG["from place to place"][0](truth())


@pytest.mark.parametrize(
    ("words", "kind", "true", "near"),
    [
        ("Each line shows where the turtle is.", LOG_POSITION, (X, Y, DRIVEN), (X + 1.0, Y, DRIVEN)),
        ("x and y are fields of the message", LOG_POSITION, (X + 1.0, Y, DRIVEN), (Y, X, DRIVEN)),
        ("x and y are swapped.", LOG_POSITION, (Y, X, DRIVEN), (X + 1.0, Y, DRIVEN)),
        ("The numbers never change.", LOG_POSITION, (X * 0, Y * 0, DRIVEN), (X + 1.0, Y, DRIVEN)),
        ("The distance stays 0. Each time a pose arrives, the step", LOG_DISTANCE, ZERO, (X, Y, 2.0 * DRIVEN)),
        ("Between two poses the turtle moves by the square root", LOG_DISTANCE, (X, Y, 2.0 * DRIVEN), ZERO),
        ("The node adds straight lines from each logged position to the next.", LOG_DISTANCE, CHORDS, ZERO),
        ("It never gets smaller.", LOG_DISTANCE, ZERO, (X, Y, DRIVEN)),
    ],
)
def test_a_sentence_about_the_numbers_is_true(words: str, kind: Kind[Any], true: Said, near: Said) -> None:
    assert words in about(kind, logged(true))
    assert words not in about(kind, logged(near))


EARLY = LogLine(-0.5, "INFO", "pose_subscriber", "x=0.00 y=0.00 distance=0.00")


@pytest.mark.parametrize(("early", "found"), [((EARLY,), True), ((), False)])
def test_numbers_before_the_first_pose_are_told(early: tuple[LogLine, ...], *, found: bool) -> None:
    reported = about(LOG_POSITION, recording(WAY, log=(*early, *logged(truth()).log)))
    assert ("A line with numbers was logged before the first pose arrived." in reported) == found
    assert ("Before the first pose, the position is unknown, not 0. Until the first pose arrives," in reported) == found


@pytest.mark.parametrize(("until_s", "busy"), [(10.0, True), (2.5, False)])
def test_a_busy_machine_is_blamed_only_if_it_delayed_nearly_all_lines(until_s: float, *, busy: bool) -> None:
    reported = about(LOG_POSITION, logged(truth(), stalls=((0.0, until_s),)))
    assert ("The machine was too busy to judge the check in wall time." in reported) == busy


@pytest.mark.parametrize(("amount", "few"), [(2, True), (3, False)])
def test_too_few_lines_are_told(amount: int, *, few: bool) -> None:
    reported = about(LOG_POSITION, recording(WAY, log=logged(truth()).log[:amount]))
    assert ("There are too few lines to compare." in reported) == few
    assert ("The log has at least 3 lines such as " in reported) == few


FIRST = "def heard(self, pose):\n            self.x = pose.x\n            self.d += pose.x - self.x"
LAST = "def heard(self, pose):\n            self.d += pose.x - self.x\n            self.x = pose.x"


@pytest.mark.parametrize(("source", "found"), [(FIRST, True), (LAST, False)])
def test_a_pose_that_is_replaced_too_early_is_told(source: str, *, found: bool) -> None:
    reported = about(LOG_DISTANCE, logged(ZERO), source)
    assert ("Line 14 replaces self.x before the step from the old value is calculated." in reported) == found
    assert ("The distance stays 0." in reported) != found


AGAIN = """def heard(self, pose):
            self.d = {}
            self.get_logger().info(f"distance={{self.d:.2f}}")"""


@pytest.mark.parametrize(
    ("value", "falls", "found"),
    [("0.0", True, True), ("math.hypot(1.0, 2.0)", True, True), ("self.d + 1.0", True, False), ("0.0", False, False)],
)
def test_a_distance_that_is_replaced_is_told(value: str, *, falls: bool, found: bool) -> None:
    x, y, driven_m = truth()
    said = (x, y, 0.5 * driven_m if not falls else driven_m % 1.0)
    reported = about(LOG_DISTANCE, logged(said), AGAIN.format(value))
    words = "replaces the distance instead of adding to it."
    assert (words in reported) == found
