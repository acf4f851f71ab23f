from __future__ import annotations

import pytest

from grader.turtlesim.turtle import FRAME_S, Start
from grader.turtlesim.world import World

SOMEWHERE = Start(2.0, 3.0, 0.0)


def test_a_world_begins_with_turtle1_in_the_middle() -> None:
    assert World().turtles["turtle1"].state()[:3] == pytest.approx((5.544445, 5.544445, 0.0), abs=1e-6)


def test_a_turtle_without_a_name_gets_the_next_number_that_is_free() -> None:
    world = World()
    world.spawn("turtle3", SOMEWHERE)
    assert [world.spawn("", SOMEWHERE), world.spawn("", SOMEWHERE)] == ["turtle2", "turtle4"]


def test_a_number_is_not_given_again_after_a_kill() -> None:
    world = World()
    world.spawn("", SOMEWHERE)
    world.kill("turtle2")
    assert world.spawn("", SOMEWHERE) == "turtle3"


def test_a_taken_name_is_refused_and_the_turtle_left_alone() -> None:
    world = World()
    assert world.spawn("turtle1", SOMEWHERE) == ""
    assert world.turtles["turtle1"].x != SOMEWHERE.x


def test_kill_tells_whether_there_was_such_a_turtle() -> None:
    world = World()
    assert [world.kill("turtle1"), world.kill("turtle1")] == [True, False]


def test_a_killed_turtle_gives_up_its_rotation() -> None:
    world = World()
    rotation = world.turtles["turtle1"].rotate_to(1.0)
    world.kill("turtle1")
    assert rotation.end == "aborted"


def test_reset_leaves_turtle1_at_its_start_and_counts_again() -> None:
    world = World(Start(1.0, 2.0, 0.5))
    world.spawn("", SOMEWHERE)
    world.command("turtle1", 1.0, 0.0, 1.0)
    world.step(0.0)
    world.reset()
    assert list(world.turtles) == ["turtle1"]
    assert world.turtles["turtle1"].state() == (1.0, 2.0, 0.5, 0.0, 0.0, False)
    assert world.spawn("", SOMEWHERE) == "turtle2"


def test_reset_wipes_the_trail_and_keeps_the_parameters() -> None:
    world = World()
    world.canvas.background = (1, 2, 3)
    world.holonomic = True
    world.command("turtle1", 2.0, 0.0, 0.0)
    world.step(0.0)
    world.reset()
    assert world.canvas.image().getcolors() == [(500 * 500, (1, 2, 3))]
    assert world.holonomic


def test_sideways_counts_only_for_a_holonomic_turtle() -> None:
    world = World()
    y = world.turtles["turtle1"].y
    world.command("turtle1", 0.0, 1.0, 0.0)
    world.step(0.0)
    assert world.turtles["turtle1"].y == y
    world.holonomic = True
    world.command("turtle1", 0.0, 1.0, 0.0)
    world.step(FRAME_S)
    assert world.turtles["turtle1"].y == pytest.approx(y + FRAME_S)


def test_every_turtle_moves_in_every_frame() -> None:
    world = World()
    world.spawn("other", SOMEWHERE)
    for name in world.turtles:
        world.command(name, 1.0, 0.0, 0.0)
    world.step(0.0)
    assert world.turtles["other"].x == pytest.approx(SOMEWHERE.x + FRAME_S)
    assert world.turtles["turtle1"].state().linear == 1.0
