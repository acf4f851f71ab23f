"""Conditions and callbacks that compare or store the wrong thing, each with a line that is nearly the same."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_condition import field_and_string, stored_before_refused, why_from_afar
from grader.checks.causes.why_steering import theta_forgotten
from grader.tests.checks.made import NODE_FILE, evidence, submission

NODE = """\
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.add_on_set_parameters_callback(self.check)

    def check(self, parameters):
        {check}
        return SetParametersResult(successful=False, reason="no")

    def distance(self, place):
        return {distance}

    def step(self):
        {step}
            self.catch()
"""


def source(
    check: str = "pass", distance: str = "math.hypot(dx, dy)", step: str = "if self.distance(place) < REACH:"
) -> str:
    return NODE.format(check=check, distance=distance, step=step)


@pytest.mark.parametrize(
    ("field", "line", "words"),
    [
        ("data", 'if request.data == "true":', "This line compares data with a string, but data is True or False."),
        ("data", "if request.data == True:", ""),
        ("data", 'if request.name == "true":', ""),
        ("status", 'if result().status != "SUCCEEDED":', "but status is a number. GoalStatus has a constant for each"),
        ("status", "if result().status != 4:", ""),
        ("status", 'if self.status == "turn":', ""),
        ("status", 'other.status = "turn"\n        if other.status == "turn":', ""),
        ("status", 'other = Turtle(status="turn")\n        if other.status == "turn":', ""),
        ("status", 'class Turtle:\n            status = 0\n        if other.status == "turn":', ""),
        ("data", 'if msg.data == "stop":', ""),
    ],
)
def test_a_field_that_is_compared_with_a_string_is_told(field: str, line: str, words: str) -> None:
    cause = field_and_string(evidence(package=submission({NODE_FILE: source(step=line)})), field)
    assert (cause is None) == (not words)
    assert cause is None or words in cause.text


@pytest.mark.parametrize(
    ("distance", "step", "words"),
    [
        ("dx ** 2 + dy ** 2", "if d < REACH:", "distance returns the square of the distance. The square root is"),
        ("dx * dx + dy * dy", "if d < REACH:", "distance returns the square of the distance. The square root is"),
        ("dx * dx + dy ** 2", "if d < REACH:", "distance returns the square of the distance. The square root is"),
        ("math.pow(dx, 2) + pow(dy, 2)", "if d < REACH:", "distance returns the square of the distance. The"),
        ("math.pow(dx, 3) + pow(dy, 3)", "if d < REACH:", ""),
        ("total", "total = dx * dx + dy * dy\n        if total < REACH:", "distance returns the square of the"),
        ("dx * ex + dy * ey", "if d < REACH:", ""),
        ("dx ** 3 + dy ** 3", "if d < REACH:", ""),
        ("dx * dx + dy * dy", "if math.sqrt(self.distance(place)) < REACH:", ""),
        ("abs(place.x - self.pose.x) + self.other(place)", "if d < REACH:", ""),
        ("(dx ** 2 + dy ** 2) ** 0.5", "if d < REACH:", ""),
        ("math.sqrt(dx ** 2 + dy ** 2)", "if d < REACH:", ""),
        ("abs(dx) + abs(dy)", "if d < REACH:", ""),
        ("abs(place.x - self.pose.x)", "if d < REACH:", "The method distance uses x, but not y."),
        ("abs(place.x - self.pose.x) + abs(place.y - self.pose.y)", "if d < REACH:", ""),
        ("0", "if self.distance(place) > REACH:", "With >, this condition holds while the target is farther away than"),
        ("0", "if self.distance(place) >= REACH:", "With >=, this condition holds while the target is farther away"),
        ("0", "if self.distance(place) > FAR:", ""),
        ("0", "while self.distance(place) > REACH:", ""),
        ("0", 'if self.distance(place) > REACH:\n            self.get_logger().info("too far to catch")', ""),
        ("0", "if self.distance(place) > REACH:\n            self.drive()", ""),
        ("0", "if self.distance(place) > REACH:\n            self.catch_client.call_async(request)", "With >,"),
        ("0", "if self.now() > self.reached_s:", ""),
        ("0", "if self.now() > self.reach_time:", ""),
        ("0", "if self.distance(place) > self.reach_m:", "With >, this condition holds while the target is farther"),
        ("dx ** 2 + dy ** 2", "if self.distance(place) < REACH ** 2:", ""),
        ("dx ** 2 + dy ** 2", "if self.distance(place) < REACH * REACH:", ""),
        ("dx ** 2 + dy ** 2", "square = REACH ** 2\n        if self.distance(place) < square:", ""),
        ("dx ** 2 + dy ** 2", "if self.distance(place) < 0.25:", ""),
        ("dx ** 2 + dy ** 2", "if math.sqrt(self.distance(place)) < REACH:", ""),
        ("dx ** 2 + dy ** 2", "near = min(self.distance(place) ** (1 / 2), 9)\n        if near < REACH:", ""),
        ("dx ** 2 + dy ** 2", "if pow(self.distance(place), 0.5) < REACH:", ""),
        ("dx ** 2 + dy ** 2", "if math.hypot(dx, dy) < REACH:", ""),
        ("dx ** 2 + dy ** 2", "if pow(self.distance(place), 2) < REACH:", "distance returns the square of"),
        ("dx ** 2 + dy ** 2", "if self.distance(place) < 2 * REACH:", "distance returns the square of the distance."),
    ],
)
def test_why_a_target_is_caught_from_afar_is_told(distance: str, step: str, words: str) -> None:
    cause = why_from_afar(evidence(package=submission({NODE_FILE: source(distance=distance, step=step)})), 0.5)
    assert (cause is None) == (not words)
    assert cause is None or cause.text.startswith(words)


def test_a_method_for_the_square_of_the_distance_is_not_told() -> None:
    code = source(distance="dx ** 2 + dy ** 2", step="if d < REACH:").replace("def distance", "def distance_sq")
    assert why_from_afar(evidence(package=submission({NODE_FILE: code})), 0.5) is None


@pytest.mark.parametrize(
    ("check", "told"),
    [
        ("self.refused_for = 0.0", False),
        ("radius = 1.0", False),
        ("self.radius = parameters[0].value", True),
        ("self.checked = True", False),
        ("self.error = None", False),
        ("self.checks = self.checks + 1", False),
        ("print(self.radius)", False),
    ],
)
def test_values_that_are_stored_before_they_are_refused_are_told(check: str, *, told: bool) -> None:
    cause = stored_before_refused(evidence(package=submission({NODE_FILE: source(check=check)})))
    words = "check stores new values in self before it refuses them. Check all values first."
    assert (cause is not None and cause.text == words) == told


OF_A_NAME = """\
class Driver(Node):
    def __init__(self):
        self.add_on_set_parameters_callback(self.check)

    def check(self, parameters):
        for each in parameters:
            if each.name == "radius":
                self.radius = each.value
            {test}:
                return SetParametersResult(successful=False, reason="no")
        return SetParametersResult(successful=True)
"""


@pytest.mark.parametrize(
    ("test", "told"),
    [
        ('if each.name == "radius"', True),
        ('if each.name == "speed"', False),
        ('elif each.name == "speed"', False),
        ("if each.value < 0.0", True),
        ("else", False),
        ("elif each.value < 0.0", False),
    ],
)
def test_a_refusal_of_another_parameter_is_not_told(test: str, *, told: bool) -> None:
    cause = stored_before_refused(evidence(package=submission({NODE_FILE: OF_A_NAME.format(test=test)})))
    assert (cause is not None) == told


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("if math.atan2(dy, dx) > 0:", True),
        ("if math.atan2(dy, dx) - self.pose.theta > 0:", False),
        ("if dy > 0:", False),
    ],
)
def test_a_direction_without_theta_is_told(line: str, *, told: bool) -> None:
    cause = theta_forgotten(evidence(package=submission({NODE_FILE: source(step=line)})))
    words = "The code never reads theta. The angle to turn by is the direction to the target minus theta."
    assert (cause is not None and cause.text == words) == told
