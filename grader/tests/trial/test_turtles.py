"""The pens and the other turtles in a recording."""

from __future__ import annotations

from grader.trial.turtles import TurtleWatch
from grader.turtlesim.turtle import FRAME_S, Pen, Start
from grader.turtlesim.world import World


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
