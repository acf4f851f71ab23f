from __future__ import annotations

import math
from dataclasses import replace

import pytest

from grader.checks.outcome import Finding, Status
from grader.checks.subjects.path import CIRCLE, CircleParams, expected_centre
from grader.tests.checks.made import NODE_FILE, Timed, every, evidence, finding, legs, node, recording
from grader.tests.checks.made import found as found_by
from grader.tests.checks.shapes import SHAPES
from grader.tests.checks.told import told
from grader.trial.recording import Pose


def circle(shape: str) -> Finding:
    return finding("circle", evidence(SHAPES[shape]()))


@pytest.mark.parametrize(
    "shape", ["good", "good elsewhere", "late", "uneven", "one hertz", "four hertz", "more after Ctrl-C"]
)
def test_a_circle_passes_at_any_rate(shape: str) -> None:
    found = circle(shape)
    assert (found.status, found.diagnosis) == (Status.PASSED, None)
    assert found.observed == "The turtle drove a circle of radius 2.0 m, counter-clockwise, for at least 1 turn."


@pytest.mark.parametrize(
    ("shape", "diagnosis", "observed"),
    [
        ("clockwise", "wrong-direction", "The turtle drove the circle clockwise."),
        ("radius 2.2", "wrong-radius", "The radius of the circle is 2.2 m."),
        ("swapped", "wrong-radius", "The radius of the circle is 0.5 m."),
        ("three quarters", "stopped-early", "The turtle drove 0.72 turns; the last command arrived at 4.0 s."),
        ("half speed", "too-short", "The turtle drove 0.76 turns."),
        ("stops and goes", "stops-and-goes", "The turtle drove 0.64 turns, with 3 stops on the way."),
        ("crash", "crash", "The turtle drove 0.67 turns."),
        (
            "square",
            "polygon",
            (
                "The trajectory has 5 straight sides with corners; "
                "it deviates by 0.13 m (RMS) from the best-fitting circle."
            ),
        ),
        ("straight on", "straight-line", "The turtle drove in a straight line."),
        ("turns on the spot", "turns-on-the-spot", "The turtle turned on the spot."),
        ("all zero", "not-moving", "The turtle did not move."),
        ("no messages", "not-moving", "The turtle did not move."),
        ("ends at once", "ended-early", "The turtle did not move."),
        ("wall", "wall", "The turtle ran into a wall after 1.7 s."),
        ("straight into the wall", "wall", "The turtle ran into a wall after 3.3 s."),
        (
            "spiral",
            "not-round",
            "The trajectory is not round: it deviates by 0.28 m (RMS) from the best-fitting circle.",
        ),
        (
            "beside its place",
            "wrong-centre",
            "The circle has the right size, but it is 0.78 m away from where it should be.",
        ),
        ("nan", "not-a-number", "The turtle's position became NaN (not a number)."),
        ("infinity", "not-a-number", "The turtle's position became NaN (not a number)."),
        ("teleported", "intervention", "Something other than a velocity command moved the turtle: teleport_absolute."),
    ],
)
def test_each_other_trajectory_fails_for_its_own_reason(shape: str, diagnosis: str, observed: str) -> None:
    found = circle(shape)
    assert (found.status, found.diagnosis, found.observed) == (Status.FAILED, diagnosis, observed)
    publishes = diagnosis in ("stopped-early", "stops-and-goes", "ended-early")
    first_line = shape in ("spiral", "crash")  # only linear.x varies, and the node crashed at this line
    line = "" if diagnosis == "intervention" else ":16" if publishes else ":14" if first_line else ":15"
    assert str(found.where) == f"{NODE_FILE}{line}"


@pytest.mark.parametrize(
    ("commands", "diagnosis"),
    [
        (legs((60, 0.6, 0.0), (15, 0.6, 2.0)), "straight-line"),
        (legs((20, 0.6, 0.0), (55, 0.6, 0.6)), "not-round"),
        (legs((30, 0.6, 0.0), (8, 0.0, 2.0), (30, 0.6, 0.0)), "polygon"),
    ],
)
def test_a_trajectory_with_straight_parts_is_reported_by_their_number(commands: list[Timed], diagnosis: str) -> None:
    found = finding("circle", evidence(recording(commands)))
    assert (found.diagnosis, str(found.where)) == (diagnosis, f"{NODE_FILE}:15")


def test_a_trajectory_that_is_not_round_is_explained_by_the_commands_only() -> None:
    assert circle("spiral").cause == "The commands change. A circle needs the same command all the time."
    two = [(t_s, 1.0 + (t_s > 5.0), 1.0) for t_s, _, _ in every(0.5, 0.0, 0.0)]
    assert finding("circle", evidence(recording(two))).cause == circle("spiral").cause
    frames = SHAPES["spiral"]().frames
    steady = replace(SHAPES["crash"](), frames=frames)
    assert finding("circle", evidence(steady)).cause == "", "a node that ends does not bend a circle"


def test_a_circle_in_the_wrong_place_is_explained_by_the_commands() -> None:
    assert "The first command differs from the last one" in circle("beside its place").cause
    backwards = finding("circle", evidence(recording(every(0.5, -2.0, 1.0))))
    assert (backwards.diagnosis, str(backwards.where)) == ("wrong-centre", f"{NODE_FILE}:14")
    assert "linear.x is negative, so the turtle drives backwards" in backwards.cause
    between = [(0.1, 2.0, 1.0), (0.3, 2.0, 0.0), *every(0.5, 2.0, 1.0)]
    assert finding("circle", evidence(recording(between))).cause == circle("spiral").cause


def test_a_wrong_radius_is_explained_by_the_commands() -> None:
    assert circle("swapped").cause.endswith("1.0 / 2.0 = 0.5 m.")
    alternating = [
        (t_s, 1.2 * (index % 2), 0.4 * (1 - index % 2)) for index, (t_s, _, _) in enumerate(every(0.1, 0, 0))
    ]
    found = finding("circle", evidence(recording(alternating)))
    assert (found.diagnosis, found.cause) == ("wrong-radius", circle("spiral").cause)


def test_two_turns_may_be_requested() -> None:
    short = found_by(CIRCLE, evidence(SHAPES["good"]()), radius_m=2.0, turns=2.0)
    assert (short.diagnosis, short.observed) == ("too-short", "The turtle drove 1.51 turns.")
    assert short.expected == "The turtle drives a circle of radius 2.0 m, counter-clockwise, for at least 2 turns."


def test_a_call_that_does_not_move_the_turtle_is_not_said_to_move_it() -> None:
    found = finding("circle", evidence(replace(SHAPES["good"](), interventions=("set_parameters",))))
    observed = "Something other than a velocity command may have changed the turtle's movement: set_parameters."
    assert (found.diagnosis, found.observed) == ("intervention", observed)
    moved = finding("circle", evidence(SHAPES["teleported"]()))
    assert "may have changed the turtle's movement" not in moved.observed


@pytest.mark.parametrize(
    ("angular", "diagnosis", "words"),
    [
        (1.0, "stopped-early", "The turtle drove 0.16 turns; the last command arrived at 0.1 s."),
        (1.5, "wrong-radius", "The radius is linear.x divided by angular.z: 2.0 / 1.5 = 1.333 m."),
    ],
)
def test_a_single_command_at_the_very_start_is_explained(angular: float, diagnosis: str, words: str) -> None:
    found = finding("circle", evidence(recording([(0.1, 2.0, angular)])))
    assert found.diagnosis == diagnosis
    assert words in told(found)


def test_the_requested_radius_is_not_rounded() -> None:
    found = found_by(CIRCLE, evidence(SHAPES["good"]()), radius_m=1.25)
    assert found.expected == "The turtle drives a circle of radius 1.25 m, counter-clockwise, for at least 1 turn."


def test_commands_that_differ_give_no_cause_for_the_size() -> None:
    commands = [(t_s, 5.0 + t_s, 1.0) for t_s, _, _ in every(0.5, 0.0, 0.0)]
    found = finding("circle", evidence(recording(commands)))
    assert (found.diagnosis, found.cause) == ("wall", "")
    unsteady = [(t_s, 1.0, 0.5 + 0.0001 * t_s) for t_s, _, _ in every(0.5, 0.0, 0.0)]
    short = finding("circle", evidence(recording(unsteady)))
    assert (short.diagnosis, short.cause) == ("too-short", "")


def test_a_radius_of_45_m_is_a_circle_and_one_of_60_m_is_a_straight_line() -> None:
    for radius_m, diagnosis in ((45.0, "wrong-radius"), (60.0, "straight-line")):
        found = finding("circle", evidence(recording(every(0.5, 0.5, 0.5 / radius_m), start=Pose(1.0, 5.0, 0.0))))
        assert found.diagnosis == diagnosis


@pytest.mark.parametrize(("turns_rad_s", "told"), [(0.0, True), (0.005, True), (0.05, False)])
def test_a_turtle_that_hardly_turns_is_told_that_it_turns_too_little(turns_rad_s: float, *, told: bool) -> None:
    found = finding("circle", evidence(recording(every(0.5, 0.6, turns_rad_s), start=Pose(1.0, 1.0, 0.5))))
    assert ("The turtle turns too little or not at all. angular.z is the turning speed." in found.cause) == told


@pytest.mark.parametrize(
    ("linear", "angular", "diagnosis"),
    [
        (0.006, 0.0, "straight-line"),
        (0.004, 0.0, "not-moving"),
        (0.0, 0.012, "turns-on-the-spot"),
        (0.0, 0.009, "not-moving"),
    ],
)
def test_slow_turtles_drive_straight_turn_on_the_spot_or_stand_still(
    linear: float, angular: float, diagnosis: str
) -> None:
    found = finding("circle", evidence(recording(every(0.5, linear, angular))))
    assert found.diagnosis == diagnosis


def test_zeros_in_one_field_are_not_all() -> None:
    only_turning = [(0.5, 0.0, 0.005), (1.0, 0.0, 0.0)]
    assert finding("circle", evidence(recording(only_turning))).cause == ""
    only_driving = [(0.5, 0.002, 0.0), (1.0, 0.0, 0.0)]
    assert finding("circle", evidence(recording(only_driving))).cause == ""


def test_a_polygon_with_sides_nearly_as_short_as_steps_fails_too() -> None:
    assert circle("many sides").diagnosis == "polygon"


def test_the_reason_for_the_size_is_what_was_commanded() -> None:
    found = circle("radius 2.2")
    assert found.cause == "The radius is linear.x divided by angular.z: 2.2 / 1.0 = 2.2 m."
    tight = finding("circle", evidence(recording(every(0.5, 1.0, 0.8))))
    assert tight.cause == "The radius is linear.x divided by angular.z: 1.0 / 0.8 = 1.25 m."
    assert circle("wall").cause == "The radius is linear.x divided by angular.z: 6.0 / 1.0 = 6.0 m."
    assert circle("straight into the wall").cause == "angular.z is 0, so the turtle drives in a straight line."


def test_the_reason_for_the_length_is_what_was_commanded_or_when_it_ended() -> None:
    assert circle("half speed").cause == "With angular.z = 0.5 rad/s, one turn takes 12.6 s."
    slow = recording(every(0.5, 1.0, 0.5, until_s=8.7))
    assert finding("circle", evidence(slow)).diagnosis == "stopped-early"


def test_a_turtle_that_crawls_does_move() -> None:
    assert finding("circle", evidence(recording(every(0.5, 0.02, 0.0)))).diagnosis == "straight-line"


def test_a_turtle_that_hardly_turns_stands_still_though_not_every_command_is_zero() -> None:
    found = finding("circle", evidence(recording(every(0.5, 0.0, 0.001))))
    assert (found.diagnosis, found.cause) == ("not-moving", "")
    assert circle("all zero").cause == "linear.x and angular.z are 0 in every command."


def test_a_wrong_direction_is_reported_at_the_line_that_sets_the_turning_speed() -> None:
    assert str(circle("clockwise").where) == "my_robot_controller/draw_circle.py:15"
    keywords = node(("msg = Twist()", "msg = Twist(angular=Vector3(z=-1.0))"), ("        msg.angular.z = 1.0\n", ""))
    found = finding("circle", evidence(SHAPES["clockwise"](), keywords))
    assert str(found.where) == "my_robot_controller/draw_circle.py:13"


@pytest.mark.parametrize(
    ("linear", "near", "status"),
    [
        (2.0, False, "passed"),
        (2.045, True, "passed"),
        (2.055, True, "failed"),
        (2.2, False, "failed"),
        (1.955, True, "passed"),
    ],
)
def test_a_radius_near_the_edge_is_for_wall_time_to_judge(linear: float, near: bool, status: str) -> None:
    found = finding("circle", evidence(recording(every(0.5, linear, 1.0))))
    assert (found.near_edge, found.status.value) == (near, status)


@pytest.mark.parametrize(
    ("until_s", "near", "status"), [(5.5, True, "failed"), (6.5, True, "passed"), (8.0, False, "passed")]
)
def test_a_trajectory_that_is_just_long_enough_is_for_wall_time_to_judge(
    until_s: float, near: bool, status: str
) -> None:
    found = finding("circle", evidence(recording(every(0.5, 2.0, 1.0, until_s=until_s))))
    assert (found.near_edge, found.status.value) == (near, status)


def test_the_centre_lies_to_the_left_of_the_start_and_clockwise_to_the_right() -> None:
    start = Pose(3.0, 4.0, math.pi / 2)
    assert expected_centre(start, CircleParams(radius_m=2.0)) == pytest.approx((1.0, 4.0))
    assert expected_centre(start, CircleParams(radius_m=2.0, direction="clockwise")) == pytest.approx((5.0, 4.0))


def test_driving_backwards_round_the_same_centre_is_clockwise() -> None:
    found = finding("circle", evidence(recording(every(0.5, -2.0, -1.0))))
    assert found.diagnosis == "wrong-direction"


def test_what_the_turtle_does_after_ctrl_c_does_not_count() -> None:
    late = recording([*every(0.5, 2.0, 1.0), (9.9, 6.0, 0.0)], sigint_t_s=9.8)
    assert finding("circle", evidence(late)).status is Status.PASSED


@pytest.mark.parametrize(
    ("shape", "status"),
    [("good", "passed"), ("wall", "failed"), ("radius 2.2", "passed"), ("all zero", "skipped"), ("nan", "skipped")],
)
def test_the_walls(shape: str, status: str) -> None:
    assert finding("wall", evidence(SHAPES[shape]())).status.value == status


@pytest.mark.parametrize(("shape", "why"), [("all zero", "the turtle did not drive"), ("nan", "position became NaN")])
def test_a_turtle_whose_position_became_nan_is_not_said_to_stand_still(shape: str, why: str) -> None:
    assert why in finding("wall", evidence(SHAPES[shape]())).observed
