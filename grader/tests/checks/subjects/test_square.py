from __future__ import annotations

import math

import pytest

from grader.checks.outcome import Finding, Status
from grader.checks.subjects.square import SQUARE
from grader.tests.checks.made import NODE_FILE, TICK_S, every, evidence, found, legs, recording, submission
from grader.tests.checks.shapes import teleported
from grader.tests.checks.told import told
from grader.trial.recording import Pose

TICKS = 10
Leg = tuple[int, float, float]


def turns(corner: str, degrees: int) -> str:
    """Return the message about a corner with this angle."""
    return f"At the {corner} corner, the turtle turns by {degrees} degrees."


def side(length_m: float = 2.0) -> Leg:
    return TICKS, length_m / (TICKS * TICK_S), 0.0


def corner(degrees: float = 90.0) -> Leg:
    return TICKS, 0.0, math.radians(degrees) / (TICKS * TICK_S)


def round_(sides: tuple[float, ...] = (2.0,) * 4, corners: tuple[float, ...] = (90.0,) * 4) -> list[Leg]:
    """Return the legs of a square: side, corner, side, ..."""
    return [leg for length, turn in zip(sides, corners, strict=True) for leg in (side(length), corner(turn))]


GAP = round_((2.1, 2.1, 1.9, 1.9), (96.0, 96.0, 96.0, 90.0))
"""Each side and each corner is correct, but the square ends 0.62 m away from its start."""


def square(parts: list[Leg], start: Pose | None = None, **values: str) -> Finding:
    return found(SQUARE, evidence(recording(legs(*parts), start)), side_m=2.0, **values)


def test_the_requested_length_of_a_side_is_not_rounded() -> None:
    small = found(SQUARE, evidence(recording(legs(*round_((1.25,) * 4)))), side_m=1.25)
    assert small.observed == "The turtle drove a square with sides of 1.25 m."


@pytest.mark.parametrize(
    "parts",
    [
        round_(),
        round_()[:-1],
        [*round_()[1:], side()],  # starts with a corner
        [leg for part in round_() for leg in (part, (2, 0.0, 0.0))],  # stops between the sides
    ],
)
@pytest.mark.parametrize("start", [None, Pose(6.0, 5.0, 1.2)])
def test_a_square_passes_in_each_allowed_form(parts: list[Leg], start: Pose | None) -> None:
    assert square(parts, start).observed == "The turtle drove a square with sides of 2.0 m."


@pytest.mark.parametrize(
    ("parts", "diagnosis", "observed"),
    [
        (round_((2.0, 2.0, 2.3, 2.0)), "side-length", "The third side is 2.30 m long: 0.30 m too long."),
        (round_((2.0, 1.5, 2.0, 2.0)), "side-length", "The second side is 1.50 m long: 0.50 m too short."),
        (round_(corners=(90.0, 60.0, 90.0, 90.0)), "corner-angle", turns("second", 60)),
        (round_(corners=(90.0, 90.0, 60.0, 90.0)), "corner-angle", turns("third", 60)),
        (round_(corners=(90.0, 90.0, 98.0, 90.0)), "corner-angle", turns("third", 98)),
        (round_(corners=(105.0,) * 4), "corner-angle", turns("first", 105)),
        (round_(corners=(90.0, -90.0, 90.0, 90.0)), "corner-angle", turns("second", -90)),
        (round_(corners=(-90.0,) * 4), "wrong-direction", "The turtle turns in the wrong direction at the corners."),
        (round_()[:5], "too-few-sides", "The trajectory has 3 sides."),
        ([side()], "too-few-sides", "The trajectory has 1 side."),
        (
            [leg for _ in range(4) for leg in (side(), (TICKS, 0.5, math.pi / 2 / (TICKS * TICK_S)))],
            "curves",
            "19 % of the trajectory is curved.",
        ),
        ([(5, 0.0, 0.0)], "not-moving", "The turtle did not drive."),
        (round_((7.5, 2.0, 2.0, 2.0)), "wall", "The turtle ran into a wall."),
        (
            GAP,
            "square-gap",
            "The fourth side ends 0.62 m away from the start position.",
        ),
    ],
)
def test_each_other_trajectory_is_reported_with_its_side_or_corner_and_by_how_much(
    parts: list[Leg], diagnosis: str, observed: str
) -> None:
    finding = square(parts, Pose(4.0, 4.0, 0.0))
    assert (finding.status, finding.diagnosis, finding.observed) == (Status.FAILED, diagnosis, observed)
    assert str(finding.where) == f"{NODE_FILE}:16"


def test_a_corner_may_be_off_by_seven_degrees_and_a_square_small() -> None:
    assert square(round_(corners=(90.0, 83.5, 90.0, 90.0))).status is Status.PASSED
    small = recording(legs(*round_((0.8,) * 4)))
    assert found(SQUARE, evidence(small), side_m=0.8).status is Status.PASSED


def test_clockwise_is_right_where_the_exercise_allows_it() -> None:
    left, right = round_(), round_(corners=(-90.0,) * 4)
    assert square(right, direction="either").status is Status.PASSED
    assert square(right, direction="clockwise").status is Status.PASSED
    assert square(left, direction="clockwise").diagnosis == "wrong-direction"


def test_a_trajectory_with_an_intervention_fails() -> None:
    moved = teleported(recording(legs(*round_())), name="teleport_relative")
    assert found(SQUARE, evidence(moved), side_m=2.0).diagnosis == "intervention"


@pytest.mark.parametrize(
    ("length", "near", "status"),
    [(2.0, False, "passed"), (2.13, True, "passed"), (2.17, True, "failed"), (2.5, False, "failed")],
)
def test_a_side_near_the_edge_is_for_wall_time_to_judge(length: float, near: bool, status: str) -> None:
    finding = square(round_((2.0, length, 2.0, 2.0)))
    assert (finding.near_edge, finding.status.value) == (near, status)


@pytest.mark.parametrize(
    ("parts", "off", "per_s"),
    [
        (round_((2.0, 2.0, 2.3, 2.0)), 0.15, 2.3 / (TICKS * TICK_S)),
        (round_(corners=(90.0, 60.0, 90.0, 90.0)), 23.0, 90.0 / (TICKS * TICK_S)),
        (GAP, 0.22, 4.0 * 2.1 / (TICKS * TICK_S)),
    ],
)
def test_what_stalls_of_the_machine_may_have_done_is_not_judged(parts: list[Leg], off: float, per_s: float) -> None:
    for share, status in ((1.02, Status.ERROR), (0.98, Status.FAILED)):
        stalled = recording(legs(*parts), Pose(4.0, 4.0, 0.0), clock="wall", stalls=((1.0, 1.0 + share * off / per_s),))
        assert found(SQUARE, evidence(stalled), side_m=2.0).status is status


def too_soon(sides: tuple[float, ...], clock: str = "wall", publish: str = "publish(Twist())") -> str | None:
    asks = submission({NODE_FILE: f"class Square:\n    def tick(self):\n        self.publisher.{publish}\n"})
    observed = evidence(recording(legs(*round_(sides)), clock=clock), asks)
    return found(SQUARE, observed, side_m=2.0).diagnosis


@pytest.mark.parametrize(("clock", "lost"), [("wall", True), ("simulated", False)])
def test_only_by_wall_time_can_the_first_commands_be_lost(clock: str, *, lost: bool) -> None:
    observed = evidence(recording(legs(*round_((1.7, 2.0, 2.0, 2.0))), clock=clock))
    words = "Commands that are published before the simulator is connected are lost."
    assert (words in found(SQUARE, observed, side_m=2.0).cause) == lost


def test_in_wall_time_a_first_side_without_its_beginning_was_begun_before_discovery() -> None:
    assert too_soon((1.7, 2.0, 2.0, 2.0)) == "too-soon"
    for others in ((2.3, 2.0, 2.0, 2.0), (1.7, 2.0, 2.0, 1.6), (2.0, 1.7, 2.0, 2.0)):
        assert too_soon(others) == "side-length"
    assert too_soon((1.7, 2.0, 2.0, 2.0), clock="simulated") == "side-length"
    assert too_soon((1.7, 2.0, 2.0, 2.0), publish="get_subscription_count()") == "side-length"


def test_only_a_last_corner_may_follow_the_fourth_side() -> None:
    assert square([*round_()[:-1], corner(40.0)]).diagnosis == "drives-on"
    assert square([*round_(), side(1.0)]).diagnosis == "drives-on"


def test_curves_are_a_share_of_the_whole_path() -> None:
    curve = (2, 2.0, 0.4)
    few = [leg for _ in range(4) for leg in (side(1.9), curve, corner(90.0 - math.degrees(0.8 * TICK_S)))]
    assert square(few, Pose(4.0, 4.0, 0.0)).diagnosis == "curves"


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        (
            "A side is too long, a corner has the wrong angle, or the turtle does not stop after the fourth side.",
            round_((7.5, 2.0, 2.0, 2.0)),
            round_((2.5,) * 4),
        ),
        ("Drive with angular.z at 0, then turn with linear.x at 0.", [(5, 2.0, 2.0)] * 4, round_()[:5]),
        ("Four sides and the turns between them must fit into", round_()[:5], [(5, 2.0, 2.0)] * 4),
        ("The second side is 1.50 m long: 0.50 m too short.", round_((2.0, 1.5, 2.0, 2.0)), round_()),
        ("The second side is 2.50 m long: 0.50 m too long.", round_((2.0, 2.5, 2.0, 2.0)), round_()),
        ("A quarter turn is pi / 2 rad, which is turning speed", round_(corners=(105.0,) * 4), round_((2.5,) * 4)),
        ("After four sides, the turtle stands still.", [*round_(), side(1.0)], round_((2.5,) * 4)),
        ("After the fourth side, the turtle drives 1.0 m further.", [*round_(), side(1.0)], round_()),
        ("After the fourth side, the turtle turns by 40 degrees.", [*round_()[:-1], corner(40.0)], round_()),
        ("The turtle drives the square counter-clockwise.", round_(corners=(-90.0,) * 4), round_((2.5,) * 4)),
    ],
)
def test_a_sentence_about_a_square_is_true(words: str, true: list[Leg], near: list[Leg]) -> None:
    start = Pose(4.0, 4.0, 0.0)
    assert words in told(square(true, start))
    assert words not in told(square(near, start))


LAST = [(t_s, v, w) for t_s, v, w in legs(*round_()[:-1], corner(40.0)) if v or w]
"""The commands of a square without the zeros at its end. The last command turns the turtle."""


@pytest.mark.parametrize(("rest_s", "found"), [(0.1, True), (3.0, False)])
def test_a_square_that_the_end_of_the_trial_cuts_short_took_too_long(rest_s: float, *, found: bool) -> None:
    end_s = LAST[-1][0] + rest_s
    assert ("the turtle was still turning: the square took too long." in cut(end_s)) == found


@pytest.mark.parametrize(("rest_s", "found"), [(3.0, True), (0.1, False)])
def test_a_turtle_without_a_command_with_zeros_continues(rest_s: float, *, found: bool) -> None:
    given = cut(LAST[-1][0] + rest_s)
    assert ("The last command has values other than 0, so the turtle continues for one second." in given) == found


def cut(end_s: float) -> str:
    return told(found(SQUARE, evidence(recording(LAST, Pose(4.0, 4.0, 0.0), sigint_t_s=end_s)), side_m=2.0))


@pytest.mark.parametrize(("turn", "found_"), [(0.0, True), (0.3, False)])
def test_a_turtle_that_never_turned_is_told(turn: float, *, found_: bool) -> None:
    given = told(found(SQUARE, evidence(recording(every(0.1, 2.0, turn))), side_m=2.0))
    assert "The turtle ran into a wall." in given
    words = "The turtle never turned. After the last timer call of a side, the state must change."
    assert (words in given) == found_
