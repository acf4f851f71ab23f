from __future__ import annotations

import math

import pytest

from grader.checks.outcome import Finding, Status
from grader.checks.subjects.values import VALUES
from grader.tests.checks.made import NODE_FILE, every, evidence, finding, node, recording
from grader.tests.checks.made import found as found_by
from grader.tests.checks.shapes import SHAPES, fields


def values(shape: str) -> Finding:
    return finding("values", evidence(SHAPES[shape]()))


def test_the_right_values_pass_and_what_comes_after_ctrl_c_does_not_count() -> None:
    assert values("good").observed == "Every command has linear.x 2.0 m/s and angular.z 1.0 rad/s, all other fields 0."
    assert values("more after Ctrl-C").status is Status.PASSED


@pytest.mark.parametrize(
    ("shape", "diagnosis", "observed", "line"),
    [
        ("radius 2.2", "wrong-value", "All 19 commands were wrong: linear.x 2.2 m/s.", 14),
        ("clockwise", "wrong-sign", "All 19 commands were wrong: angular.z -1.0 rad/s.", 15),
        ("degrees", "degrees", "All 19 commands were wrong: angular.z 57.3 rad/s.", 15),
        ("swapped", "values-swapped", "All 19 commands were wrong: linear.x 1.0 m/s and angular.z 2.0 rad/s.", 14),
        ("angular.x", "wrong-field", "All 19 commands were wrong: angular.x 1.0 rad/s and angular.z 0.0 rad/s.", 13),
        ("linear.y", "wrong-field", "All 19 commands were wrong: linear.x 0.0 m/s and linear.y 2.0 m/s.", 13),
        ("all zero", "empty-twist", "All 19 commands were wrong: linear.x 0.0 m/s and angular.z 0.0 rad/s.", 14),
        ("nan", "not-a-number", "All 19 commands were wrong: linear.x NaN (not a number) m/s.", 14),
        ("infinity", "not-a-number", "All 19 commands were wrong: angular.z infinity rad/s.", 15),
        ("one wrong", "values-change", "1 of 19 commands was wrong: angular.z 1.001 rad/s.", 15),
        ("spiral", "wrong-value", "All 19 commands were wrong: linear.x 1.05 m/s in the first of them.", 14),
    ],
)
def test_each_wrong_value_fails_for_its_own_reason(shape: str, diagnosis: str, observed: str, line: int) -> None:
    found = values(shape)
    assert (found.status, found.diagnosis, found.observed) == (Status.FAILED, diagnosis, observed)
    assert str(found.where) == f"{NODE_FILE}:{line}"


@pytest.mark.parametrize(("shape", "told"), [("nan", True), ("infinity", True), ("radius 2.2", False)])
def test_a_value_that_is_not_a_number_may_come_from_a_calculation(shape: str, *, told: bool) -> None:
    assert ("NaN or infinity may come from a calculation without a defined result" in values(shape).cause) == told


def test_where_nothing_arrives_no_value_is_called_wrong() -> None:
    found = values("no messages")
    assert (found.diagnosis, found.observed) == ("no-commands", "No command arrived.")
    assert found.expected == "linear.x 2.0 m/s and angular.z 1.0 rad/s, all other fields 0."


@pytest.mark.parametrize(
    ("linear", "angular", "diagnosis", "line"),
    [
        ((2.0, 0.0, 0.0), (0.0, 0.0, 0.0), "wrong-value", 15),
        ((2.0, 0.0, 0.0), (0.0, 1.0, 0.0), "wrong-field", 13),
        ((2.0, 0.0, 3.0), (0.0, 0.0, 1.0), "wrong-value", 13),
        ((3.0, 2.0, 0.0), (0.0, 0.0, 1.0), "wrong-value", 14),
        ((0.0, 3.0, 0.0), (0.0, 0.0, 1.0), "wrong-value", 14),
        ((-2.0, 0.0, 0.0), (0.0, 0.0, 1.0), "wrong-sign", 14),
        ((2.0, 0.0, 0.0), (0.0, 0.0, math.radians(1.0)), "degrees", 15),
        ((math.degrees(2.0), 0.0, 0.0), (0.0, 0.0, 1.0), "wrong-value", 14),
        ((2.0, 0.0, 0.0), (math.inf, 0.0, -1.0), "not-a-number", 13),
        ((1.0, 0.0, 0.0), (0.0, 0.0, 2.01), "wrong-value", 14),
        ((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), "wrong-value", 14),
        ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0), "wrong-value", 14),
        ((1.0, 2.0, 0.0), (0.0, 0.0, 1.0), "wrong-value", 14),
    ],
)
def test_a_command_tells_which_mistake_it_is(
    linear: tuple[float, float, float], angular: tuple[float, float, float], diagnosis: str, line: int
) -> None:
    found = finding("values", evidence(fields(linear, angular)))
    assert (found.diagnosis, str(found.where)) == (diagnosis, f"{NODE_FILE}:{line}")


def test_where_turning_is_as_fast_as_driving_nothing_can_be_swapped() -> None:
    given = evidence(recording(every(0.5, 1.0, 1.0)))
    assert found_by(VALUES, given, linear_x_m_s=1.0, angular_z_rad_s=1.0).status is Status.PASSED
    aside = evidence(fields((1.0, 3.0, 0.0), (0.0, 0.0, 1.0)))
    assert found_by(VALUES, aside, linear_x_m_s=1.0, angular_z_rad_s=1.0).diagnosis == "wrong-value"
    other = evidence(recording(every(0.5, 1.0, 0.5)))
    assert found_by(VALUES, other, linear_x_m_s=1.0, angular_z_rad_s=1.0).diagnosis == "wrong-value"


def test_a_turtle_that_should_stand_still_and_drives_is_wrong() -> None:
    still = found_by(VALUES, evidence(recording(every(0.5, 0.0, 0.0))))
    assert (still.status, still.observed) == (Status.PASSED, "Every command has all fields 0.")
    moving = found_by(VALUES, evidence(recording(every(0.5, 1.0, 0.0))))
    assert (moving.diagnosis, moving.expected) == ("wrong-value", "All fields 0.")


def test_a_field_in_the_wrong_place_is_reported_with_what_it_does() -> None:
    assert values("linear.y").cause.endswith("the turtle drives along linear.x only.")
    assert values("angular.x").cause.endswith("the turtle turns about the z axis, which points up.")


def test_a_single_command_is_in_the_singular() -> None:
    found = finding("values", evidence(recording([(0.5, 2.0, 2.0)])))
    assert found.observed == "The only command was wrong: angular.z 2.0 rad/s."
    assert "The only command was wrong" not in values("clockwise").observed


def test_some_wrong_commands_of_a_known_kind_keep_their_name() -> None:
    some = [*every(0.5, 2.0, 1.0)[:-1], (9.504, 2.0, -1.0)]
    found = finding("values", evidence(recording(some)))
    assert (found.diagnosis, found.observed) == ("wrong-sign", "1 of 19 commands was wrong: angular.z -1.0 rad/s.")
    two = [*every(0.5, 2.0, 1.0)[:-2], (9.0, 2.0, 1.5), (9.504, 2.0, 1.25)]
    found = finding("values", evidence(recording(two)))
    assert (found.diagnosis, found.observed) == (
        "values-change",
        "2 of 19 commands were wrong: angular.z 1.5 rad/s in the first of them.",
    )


@pytest.mark.parametrize("field", range(6))
@pytest.mark.parametrize("wrong", [math.nan, math.inf, -math.inf, 2e-6, -2e-6])
def test_a_wrong_value_in_any_field_fails(field: int, wrong: float) -> None:
    six = [2.0, 0.0, 0.0, 0.0, 0.0, 1.0]
    six[field] += wrong
    found = finding("values", evidence(fields((six[0], six[1], six[2]), (six[3], six[4], six[5]))))
    assert found.status is Status.FAILED
    assert ("linear.x", "linear.y", "linear.z", "angular.x", "angular.y", "angular.z")[field] in found.observed


def test_rounding_never_hides_the_difference() -> None:
    found = finding("values", evidence(recording(every(0.5, 2.00001, 1.0))))
    assert "linear.x 2.00001 m/s" in found.observed


@pytest.mark.parametrize(
    ("off", "near", "status"),
    [(0.0, False, "passed"), (0.9e-6, True, "passed"), (1.1e-6, True, "failed"), (1.3e-6, False, "failed")],
)
def test_a_value_near_the_edge_of_its_tolerance_is_marked(off: float, near: bool, status: str) -> None:
    found = finding("values", evidence(recording(every(0.5, 2.0 + off, 1.0))))
    assert (found.near_edge, found.status.value) == (near, status)


def test_an_empty_message_is_reported_where_it_is_published() -> None:
    commands = [(0.3, 0.0, 0.0), *every(0.5, 2.0, 1.0)]
    plain = evidence(recording(commands), node())
    empty = ("        msg = Twist()", "        self.publisher.publish(Twist())\n        msg = Twist()")
    found, other = (finding("values", given) for given in (evidence(recording(commands), node(empty)), plain))
    assert (found.diagnosis, str(found.where)) == ("empty-twist", f"{NODE_FILE}:13")
    assert (other.diagnosis, str(other.where)) == ("empty-twist", f"{NODE_FILE}:14")


@pytest.mark.parametrize(
    ("shape", "words"),
    [
        ("clockwise", "The sign is wrong."),
        ("degrees", "Angles are in radians. This value looks like degrees."),
        ("all zero", "All fields of a new Twist are 0. Set the fields before you publish the message."),
        ("linear.y", "linear.y has the value that belongs in linear.x: the turtle drives along linear.x only."),
        ("angular.x", "angular.x has the value that belongs in angular.z: the turtle turns about the z axis"),
        ("swapped", "The forward speed and the turning speed are swapped."),
        ("one wrong", "The other commands were right. Something changes the values while the node runs."),
    ],
)
def test_the_cause_of_one_wrong_value_is_not_told_for_another(shape: str, words: str) -> None:
    others = ("clockwise", "degrees", "all zero", "linear.y", "angular.x", "swapped", "one wrong", "radius 2.2")
    assert [each for each in others if words in values(each).cause] == [shape]
