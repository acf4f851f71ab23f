"""Mistakes in how a node follows the pose, each with a line that is nearly the same."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_steering import compared_exactly, rounded_steps, why_steering
from grader.tests.checks.crashes import LOOK, line_with
from grader.tests.checks.made import NODE_FILE, evidence, submission

NODE = """\
class Driver(Node):
    def __init__(self):
        super().__init__("driver")
        self.target = 90.0
        self.create_timer(0.1, self.step)

    def step(self):
        {line}

rclpy.spin(Driver())
"""
LOOP = "This loop is in a callback. While it runs, a node with one thread receives no new pose."
THETA = "theta is in radians, from -pi to pi, so it never reaches this value, which may be in degrees."
SIDEWAYS = "linear.x and linear.y are speeds forwards and to the left of the turtle, not along x and y"
EXACT = "but the turtle hardly ever has exactly this coordinate. Compare the distance to the goal with a small"
SPEED = "linear_velocity is a speed, and it is negative when the turtle drives backwards. Add the distance"


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("while self.pose.x < 8: self.publisher.publish(msg)  # look", LOOP),
        ("while self.pose.x < 8: self.publisher.publish(msg); rclpy.spin_once(self)", ""),
        ("while self.pose.x < 8: self.publisher.publish(msg); spin_once(self)", ""),
        ("async def go():\n            while self.pose: self.publisher.publish(msg); await x\n        use(go)", ""),
        ("while self.ticks < 8: self.publisher.publish(msg)", ""),
        ("if self.pose.x < 8: self.publisher.publish(msg)", ""),
        ("if self.pose.theta >= 90: pass  # look", THETA),
        ("if self.pose.theta >= self.target: pass  # look", THETA),
        ("if self.pose.theta >= 1.57: pass", ""),
        ("if self.pose.theta >= self.other: pass", ""),
        ("self.target = math.radians(self.target)\n        if self.pose.theta >= self.target: pass", ""),
        ("self.target *= math.pi / 180\n        if self.pose.theta >= self.target: pass", ""),
        ("for self.target in self.targets:\n            if self.pose.theta >= self.target: pass", ""),
        ("turn = 90\n\n    def other(self, turn):\n        if self.pose.theta >= turn: pass", ""),
        (f"if self.pose.theta >= {'9' * 310}: pass", ""),
        ("if self.pose.x >= 90: pass", ""),
        ("self.target += 90.0\n        if self.pose.theta >= self.target: pass  # look", THETA),
        ("self.list[0] = 1\n        if self.pose.theta >= 90 - 0.1: pass  # look", THETA),
        ("self.target -= 90.0\n        if self.pose.theta >= self.target: pass", ""),
        ("self.target *= 0.0175\n        if self.pose.theta >= self.target: pass", ""),
        ("self.target = math.radians(90)\n        if self.pose.theta >= self.target: pass", ""),
        ("self.target, self.speed = self.next()\n        if self.pose.theta >= self.target: pass", ""),
        ("def turn(angle):\n            if self.pose.theta > angle: pass\n        angle = 90; turn(angle / 57.3)", ""),
        (f"if self.pose.theta > {'9' * 310}: pass", ""),
        ("self.theta = to_degrees(msg.theta)\n        if self.theta >= 90: pass", ""),
        ("self.pose = Place(theta=msg.theta * 57.3)\n        if self.pose.theta >= 90: pass", ""),
        ("self.pose = Place(math.degrees(msg.theta))\n        if self.pose.theta >= 90: pass", ""),
        ("msg.linear.y = 1.0 * (2.5 - self.pose.y)  # look", SIDEWAYS),
        ("msg.linear.y = 0.0", ""),
        ("t = self.pose.theta; msg.linear.y = math.cos(t) * dy - math.sin(t) * dx", ""),
        ("c, s = cos(self.pose.theta), sin(self.pose.theta)\n        msg.linear.y = c * dy - s * dx", ""),
        ("msg.linear.y = 2.5 - self.pose.y; t = self.pose.theta  # look", SIDEWAYS),
        ("msg.linear.x = 1.0 * (2.5 - self.pose.y)", ""),
    ],
)
def test_a_mistake_with_the_pose_is_told(line: str, words: str) -> None:
    source = NODE.format(line=line)
    cause = why_steering(evidence(package=submission({NODE_FILE: source})))
    assert (cause is None) == (not words)
    if cause is not None:
        assert cause.text.startswith(words)
        assert cause.where is not None
        assert cause.where.line == line_with(LOOK, source)


def test_another_thread_may_receive_the_pose() -> None:
    source = NODE.format(line="while self.pose.x < 8: self.publisher.publish(msg)")
    source = source.replace("rclpy.spin(Driver())", "MultiThreadedExecutor().spin()")
    assert why_steering(evidence(package=submission({NODE_FILE: source}))) is None


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("if self.pose.x == 8.5: pass", "This line compares a coordinate with ==,"),
        ("if self.pose.y != GOAL[1]: pass", "This line compares a coordinate with !=,"),
        ("if self.pose.x >= 8.5: pass", ""),
        ("if self.state == 8.5: pass", ""),
        ("if self.pose.theta == 8.5: pass", ""),
        ("if self.pose.x == self.last_pose.x: pass", ""),
        ("if self.pose.x == self.last_x: pass", ""),
        ("if self.pose.x == 0.0: return", ""),
        ("if self.goal_pose.x != self.last_goal_pose.x: pass", ""),
        ("if self.target_pose.x == 8.5: pass", ""),
        ("if self.pose.x == self.goal_pose.x: pass", "This line compares a coordinate with ==,"),
        ("if self.pose.x == self.goal_x: pass", "This line compares a coordinate with ==,"),
    ],
)
def test_an_exact_coordinate_is_told(line: str, told: str) -> None:
    cause = compared_exactly(evidence(package=submission({NODE_FILE: NODE.format(line=line)})))
    assert (cause is None) == (not told)
    assert cause is None or (cause.text.startswith(told) and EXACT in cause.text)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("self.distance += round(math.hypot(dx, dy), 2)", "Each step is rounded before it is added, so the errors"),
        ("self.distance += int(math.hypot(dx, dy))", "Each step is rounded before it is added, so the errors add up"),
        ("self.distance += pose.linear_velocity * 0.016", SPEED),
        ("self.distance += math.hypot(dx, dy)", ""),
        ("self.moves += int(moved)", ""),
        ("self.distance += steps[int(now)]", ""),
        ("self.distance += round(math.hypot(dx, dy), 9)", ""),
        ("self.distance += abs(pose.linear_velocity) * 0.016", ""),
        ("self.distance += pose.linear_velocity * self.passed()", SPEED),
        ("self.distance += (pose.linear_velocity ** 2) ** 0.5 * 0.016", ""),
        ("self.distance = round(math.hypot(dx, dy), 2)", ""),
        ("self.distance -= round(math.hypot(dx, dy), 2)", ""),
    ],
)
def test_a_sum_of_other_steps_is_told(line: str, words: str) -> None:
    cause = rounded_steps(evidence(package=submission({NODE_FILE: NODE.format(line=line)})))
    assert (cause is None) == (not words)
    assert cause is None or cause.text.startswith(words)
