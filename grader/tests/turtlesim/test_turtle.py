"""The motion of a turtle, compared with recordings of the real turtlesim, and tests of each rule."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.turtlesim.replay import replay, rotations
from grader.turtlesim.turtle import FRAME_S, SIDE_M, Pen, Rgb, Start, Turtle, normalize

RECORDINGS = sorted((Path(__file__).parents[1] / "golden" / "turtlesim").glob("*.inputs.csv"))
PRECISION = 1e-6
"""The difference between two neighbouring 32-bit floats at the largest coordinate of the canvas."""


class NoCanvas:
    """A canvas that ignores everything."""

    def line(self, x0: float, y0: float, x1: float, y1: float, pen: Pen) -> None:
        pass

    def color_at(self, x: float, y: float) -> Rgb:  # noqa: ARG002
        return (0, 0, 0)


def frames(turtle: Turtle, count: int, first: int = 0) -> None:
    for frame in range(first, first + count):
        turtle.update(FRAME_S, frame * FRAME_S, NoCanvas())


def poses_of(inputs: Path) -> Path:
    return inputs.with_name(inputs.name.replace(".inputs.", ".poses."))


# --- recordings ---------------------------------------------------------------------------------------------------


def test_all_recordings_are_found() -> None:
    assert len(RECORDINGS) == 8


@pytest.mark.parametrize("inputs", RECORDINGS, ids=lambda path: path.name.split(".")[0])
def test_every_pose_is_that_of_the_real_turtlesim(inputs: Path) -> None:
    assert replay(inputs, poses_of(inputs)).size <= PRECISION


def test_a_recording_that_differs_is_reported(tmp_path: Path) -> None:
    inputs = RECORDINGS[0]
    lines = poses_of(inputs).read_text().splitlines()
    frame, x, *rest = lines[500].split(",")
    lines[500] = ",".join([frame, repr(float(x) + 2e-5), *rest])
    changed = tmp_path / "changed.poses.csv"
    changed.write_text("\n".join(lines))
    worst = replay(inputs, changed)
    assert (worst.frame, worst.field) == (int(frame), "x")
    assert worst.size > 1e-5


def test_feedback_of_rotate_absolute_is_that_of_the_real_turtlesim() -> None:
    inputs = next(path for path in RECORDINGS if path.name.startswith("h_"))
    with inputs.with_name("h_rotate_absolute.feedback.csv").open(newline="") as file:
        recorded = [float(row["remaining"]) for row in csv.DictReader(file)]
    ours = [rotation.remaining for rotation in rotations(inputs, frames=568) if rotation.end != "canceled"]
    assert ours == pytest.approx(recorded, abs=PRECISION)


# --- angles -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("angle", "same"),
    [(0.0, 0.0), (math.pi, -math.pi), (-math.pi, -math.pi), (3.5, 3.5 - math.tau), (-3.5, math.tau - 3.5)],
)
def test_angles_lie_from_minus_pi_up_to_pi(angle: float, same: float) -> None:
    assert normalize(angle) == pytest.approx(same)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_any_finite_angle_is_normalized(angle: float) -> None:
    assert -math.pi <= normalize(angle) < math.pi


@given(st.floats(-1e3, 1e3))
def test_a_normalized_angle_is_the_same_direction(angle: float) -> None:
    assert math.cos(normalize(angle)) == pytest.approx(math.cos(angle), abs=1e-9)
    assert math.sin(normalize(angle)) == pytest.approx(math.sin(angle), abs=1e-9)


# --- unusual requests -----------------------------------------------------------------------------------------------

numbers = st.floats(allow_nan=False, allow_infinity=False, width=32)
speeds = st.floats(-20.0, 20.0)
requests = st.one_of(
    st.tuples(st.just("command"), speeds, speeds, speeds),
    st.tuples(st.just("teleport_absolute"), numbers, numbers, numbers),
    st.tuples(st.just("teleport_relative"), numbers, numbers),
    st.tuples(st.just("rotate_to"), numbers),
)


@given(st.lists(requests, max_size=12), st.integers(1, 80))
def test_a_turtle_stays_on_the_canvas(requested: list[tuple[str, float]], between: int) -> None:
    turtle = Turtle()
    for number, (what, *values) in enumerate(requested):
        getattr(turtle, what)(*values)
        frames(turtle, between, first=number * between)
        state = turtle.state()
        assert 0.0 <= state.x <= SIDE_M
        assert 0.0 <= state.y <= SIDE_M
        assert -math.pi <= state.theta < math.pi
        assert state.linear >= 0.0


anything = st.floats(allow_nan=True, allow_infinity=True)


@given(anything, anything, anything)
def test_numbers_that_are_none_do_not_stop_the_simulator(x: float, y: float, z: float) -> None:
    turtle = Turtle()
    turtle.command(x, y, z)
    frames(turtle, 2)
    turtle.teleport_relative(x, y)
    turtle.rotate_to(z)
    frames(turtle, 2, first=2)
    turtle.teleport_absolute(x, y, z)
    frames(turtle, 2, first=4)
    turtle.command(0.0, 0.0, 0.0)
    turtle.teleport_absolute(1.0, 2.0, 0.5)
    frames(turtle, 1, first=6)
    assert turtle.state() == (1.0, 2.0, 0.5, 0.0, 0.0, False)


def test_a_command_that_is_no_number_shows_in_the_pose() -> None:
    turtle = Turtle()
    turtle.command(math.nan, 0.0, 0.0)
    frames(turtle, 1)
    assert math.isnan(turtle.state().x)


# --- the time-out ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("age_s", "moves"), [(1.0, True), (1.0 + 1e-9, False)])
def test_a_command_lives_for_one_second(age_s: float, moves: bool) -> None:
    turtle = Turtle()
    turtle.command(1.0, 0.0, 0.0)
    turtle.update(FRAME_S, 0.0, NoCanvas())
    turtle.update(FRAME_S, age_s, NoCanvas())
    assert (turtle.state().linear > 0.0) == moves


def test_a_teleport_does_not_lengthen_a_command() -> None:
    turtle = Turtle()
    turtle.command(1.0, 0.0, 0.0)
    turtle.update(FRAME_S, 0.0, NoCanvas())
    turtle.teleport_absolute(5.0, 5.0, 0.0)
    turtle.update(FRAME_S, 0.9, NoCanvas())
    turtle.update(FRAME_S, 1.1, NoCanvas())
    assert turtle.state().linear == 0.0


def test_a_teleport_does_not_stop_the_turtle() -> None:
    turtle = Turtle()
    turtle.command(1.0, 0.0, 0.0)
    turtle.teleport_absolute(5.0, 5.0, 0.0)
    frames(turtle, 1)
    assert turtle.state().x == pytest.approx(5.0 + FRAME_S)


def test_a_rotation_may_last_longer_than_a_command() -> None:
    turtle = Turtle()
    turtle.command(0.0, 0.0, 0.0)
    frames(turtle, 1)
    rotation = turtle.rotate_to(3.0)
    frames(turtle, 200, first=1)
    assert rotation.end == "succeeded"
    assert turtle.theta == pytest.approx(3.0, abs=0.02)


# --- walls ----------------------------------------------------------------------------------------------------------


def test_a_wall_stops_the_turtle_but_not_its_wish_to_move() -> None:
    turtle = Turtle(Start(SIDE_M - 0.01, 5.0, 0.3))
    turtle.command(2.0, 0.0, 0.0)
    frames(turtle, 3)
    state = turtle.state()
    assert (state.x, state.theta, state.linear, state.wall) == (SIDE_M, 0.3, 2.0, True)


def test_off_the_wall_the_frame_is_not_clamped() -> None:
    turtle = Turtle(Start(SIDE_M - 0.01, 5.0, 0.0))
    turtle.command(2.0, 0.0, 0.0)
    frames(turtle, 2)
    turtle.command(-2.0, 0.0, 0.0)
    frames(turtle, 1, first=2)
    assert not turtle.state().wall
    assert turtle.state().linear == 2.0


# --- rotate_absolute ------------------------------------------------------------------------------------------------


def test_a_rotation_ends_with_the_turn_back_to_its_start() -> None:
    turtle = Turtle(Start(5.0, 5.0, 0.5))
    rotation = turtle.rotate_to(1.5)
    frames(turtle, 80)
    assert rotation.end == "succeeded"
    assert rotation.delta == pytest.approx(0.5 - turtle.theta)
    assert turtle.state().angular == 0.0


def test_a_command_aborts_a_rotation() -> None:
    turtle = Turtle()
    rotation = turtle.rotate_to(1.5)
    frames(turtle, 5)
    turtle.command(1.0, 0.0, 0.0)
    frames(turtle, 1, first=5)
    assert rotation.end == "aborted"
    assert turtle.state().linear == 1.0


def test_a_second_goal_aborts_the_first() -> None:
    turtle = Turtle()
    first = turtle.rotate_to(1.5)
    second = turtle.rotate_to(-1.5)
    frames(turtle, 1)
    assert (first.end, second.end) == ("aborted", None)


def test_a_cancelled_rotation_stops_in_the_next_frame() -> None:
    turtle = Turtle()
    rotation = turtle.rotate_to(1.5)
    frames(turtle, 5)
    rotation.cancel = True
    frames(turtle, 1, first=5)
    assert rotation.end == "canceled"
    assert turtle.theta == pytest.approx(5 * FRAME_S)
