"""The reasons why a turtle that drives until the end catches no target, each with a trial that differs in one thing."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.causes.why_not_reached import why_not_reached
from grader.checks.exercises import find_exercise
from grader.exercise.own_numbers import draw_numbers, to_toml
from grader.tests.checks.made import NODE_FILE, evidence, exercise, recording, submission
from grader.trial.observed import Call, Track

if TYPE_CHECKING:
    from grader.tests.checks.made import Timed

STEP = find_exercise("13-catch-them-all")
assert STEP.numbers is not None
SPEC = STEP.numbers
REACH_M = float(draw_numbers(SPEC, "alice").values["reach_m"])
NODE = """\
import math

REACH = 0.1


class CatcherNode:
    def step(self):
        name = min(self.places, key=self.distance)
        if self.distance(name) < REACH:
            self.client.call_async(name)
        msg.angular.z = 4.0 * (math.atan2(dy, dx) - self.pose.theta)
        self.publisher.publish(msg)

    def start(self):
        self.client = self.create_client(Kill, "/catch")
        self.timer = self.create_timer(0.1, self.step)
"""
LEFT: list[Timed] = [(0.1 * number, 0.0, 0.01) for number in range(1, 60)]
RIGHT_TURN: list[Timed] = [(0.1 * number, 0.0, -0.2) for number in range(1, 60)]
LEFT_TURN: list[Timed] = [(t_s, linear, -angular) for t_s, linear, angular in RIGHT_TURN]
ASKED = (Call(1.0, "/catch", "turtlesim/srv/Kill", {"name": "far"}, {}, 1.0),)


def cause(
    source: str = NODE, near_m: float = 2.0, commands: list[Timed] = LEFT, calls: tuple[Call, ...] = (), y: float = 9.0
) -> str:
    """Return the diagnosis, the line and the text for a target above turtle1, which looks to the right."""
    far = Track("far", ((0.0, 5.544445, y, 0.0),), None)
    files = {NODE_FILE: source, SPEC.file: to_toml(draw_numbers(SPEC, "alice"))}
    trial = recording(commands, tracks=(far,), calls=calls)
    given = evidence(trial, submission(files), exercise=replace(exercise(), numbers=SPEC))
    found = why_not_reached(given, "far", near_m)
    return "" if found is None else f"{found.diagnosis} {found.where}: {found.text}"


SWAPPED = NODE.replace("atan2(dy, dx)", "atan2(place.x - self.pose.x, place.y - self.pose.y)")
DEGREES = NODE.replace("math.atan2(dy, dx)", "math.degrees(math.atan2(dy, dx))")
LOGGED = NODE.replace(
    "        self.publisher", "        self.get_logger().info(f'{math.degrees(1.0)}')\n        self.publisher"
)
NAMED = NODE.replace(
    "        self.publisher",
    "        deg = math.degrees(1.0)\n        self.get_logger().info(f'{deg}')\n"
    "        use({angle})\n        self.publisher",
)
MOST = NODE.replace("min(", "max(") + "\n    def distance(self, name):\n        away = self.away(name)\n"


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("reach-too-small my_robot_controller/draw_circle.py:3: ", cause(near_m=0.2), cause(near_m=REACH_M + 0.1)),
        (f"The turtle came within 0.20 m of far, and your reach is {REACH_M:g} m, but the", cause(near_m=0.2), ""),
        (
            "The node has no client, so it calls no service. /catch is a service, not a topic.",
            cause(NODE.replace("create_client", "create_publisher"), near_m=0.2),
            cause(near_m=0.2),
        ),
        (
            "Nothing calls step.",
            cause(NODE.replace("create_timer(0.1, self.step)", "create_timer(0.1, print)"), near_m=0.2),
            cause(near_m=0.2),
        ),
        ("Which distance does the node compare with your reach?", cause(near_m=0.2), cause(near_m=0.2, calls=ASKED)),
        ("atan2-swapped my_robot_controller/draw_circle.py:11: ", cause(SWAPPED), cause()),
        ("math.atan2 takes the difference in y first, and then the difference in x.", cause(SWAPPED), cause(DEGREES)),
        ("angle-in-degrees my_robot_controller/draw_circle.py:11: ", cause(DEGREES), cause()),
        (
            "this line converts an angle to degrees.",
            cause(DEGREES),
            cause(NODE.replace("4.0 *", "radians(4.0) *")),
        ),
        ("angle-in-degrees", cause(DEGREES), cause(LOGGED)),
        ("farthest-chosen", cause(MOST), cause(MOST.replace("=self.distance", "=lambda name: -self.distance(name)"))),
        ("angle-in-degrees", cause(NAMED.replace("{angle}", "angle + deg")), cause(NAMED)),
        (
            "farthest-chosen",
            cause(MOST),
            cause(MOST.replace("=self.distance", "=lambda name: 1 / self.distance(name)")),
        ),
        ("farthest-chosen", cause(MOST + "        return away"), cause(MOST + "        return -away")),
        ("farthest-chosen my_robot_controller/draw_circle.py:8: ", cause(MOST), cause()),
        ("max with a key returns the target for which", cause(MOST), cause(NODE.replace("4.0 *", "max(4.0, 5.0) *"))),
        ("turns-away my_robot_controller/draw_circle.py:11: ", cause(commands=RIGHT_TURN), cause(commands=LEFT_TURN)),
        ("commands to turn, the turtle turned away from the", cause(commands=RIGHT_TURN), cause(commands=LEFT)),
        (
            "A positive angular.z turns to the left: the error is the direction to the target minus theta.",
            cause(commands=RIGHT_TURN),
            cause(commands=RIGHT_TURN, y=2.0),
        ),
        ("turns-away", cause(commands=RIGHT_TURN), cause(commands=RIGHT_TURN[:8])),
    ],
)
def test_the_source_or_the_path_shows_the_mistake(words: str, true: str, near: str) -> None:
    assert words in true
    assert words not in near


def test_a_turn_towards_a_target_behind_may_have_any_direction() -> None:
    behind = Track("far", ((0.0, 2.0, 5.544445, 0.0),), None)
    commands = [(0.1 * number, 0.0, math.copysign(0.2, number % 2 - 0.5)) for number in range(1, 60)]
    trial = recording(commands, tracks=(behind,))
    assert why_not_reached(evidence(trial, submission({NODE_FILE: NODE})), "far", 3.0) is None
