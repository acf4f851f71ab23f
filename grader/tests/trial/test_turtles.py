"""The pens and the other turtles in a recording."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.trial import turtles
from grader.trial.turtles import TurtleWatch
from grader.turtlesim.turtle import FRAME_S, Pen, Start
from grader.turtlesim.world import World

if TYPE_CHECKING:
    import pytest


def test_pens_and_other_turtles_are_recorded_as_they_change() -> None:
    world, watch = World(), TurtleWatch()

    def frames(first: int, last: int) -> None:
        for frame in range(first, last):
            world.step(frame * FRAME_S)
            watch.look(frame * FRAME_S, world)

    frames(0, 2)
    world.turtles["turtle1"].pen = Pen((255, 0, 0), 4)
    world.spawn("other", Start(2.0, 3.0, 0.0))
    frames(2, 4)
    world.command("other", 1.0, 0.0, 0.0)
    frames(4, 6)
    world.kill("other")
    frames(6, 8)
    world.spawn("other", Start(1.0, 1.0, 0.0))
    frames(8, 9)
    (change,) = watch.pens
    assert (change.t_s, change.turtle, change.color, change.width, change.down) == (
        2 * FRAME_S,
        "turtle1",
        (255, 0, 0),
        4,
        True,
    )
    first, second = watch.tracks
    assert [row[0] for row in first.rows] == [2 * FRAME_S, 4 * FRAME_S, 5 * FRAME_S]
    assert first.rows[0][1:] == (2.0, 3.0, 0.0)
    assert (first.gone_s, second.gone_s) == (6 * FRAME_S, None)
    assert second.rows[0][1:] == (1.0, 1.0, 0.0)


def test_a_crowd_of_turtles_does_not_hide_a_target(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(turtles, "MOST_ROWS", 3)
    world, watch = World(), TurtleWatch(["target"])
    for name in ("target", *(f"other{number}" for number in range(5))):
        world.spawn(name, Start())
    watch.look(0.0, world)
    world.turtles["target"].x = 1.0
    watch.look(FRAME_S, world)
    rows = {track.turtle: len(track.rows) for track in watch.tracks}
    assert (rows["target"], sum(rows.values())) == (2, 5)


def test_many_changes_to_pens_do_not_hide_that_a_new_turtle_was_killed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(turtles, "MOST_CHANGES", 1)
    world, watch = World(), TurtleWatch()
    for frame in range(3):
        world.turtles["turtle1"].pen = Pen(width=frame + 1)
        watch.look(frame * FRAME_S, world)
    world.spawn("other", Start())
    watch.look(3 * FRAME_S, world)
    world.kill("other")
    watch.look(4 * FRAME_S, world)
    assert len(watch.pens) == 1
    assert [(track.turtle, track.gone_s) for track in watch.tracks] == [("other", 4 * FRAME_S)]
