"""Replay a recording of the real turtlesim, and compare its poses with those of our turtle.

    python -m grader.turtlesim.replay NAME.inputs.csv NAME.poses.csv

The columns of the files are `frame,input,a,b,c` and `frame,x,y,theta,linear_velocity,angular_velocity`. The inputs of a
frame take effect in the order of the file, in the update that produces the pose of the frame.
"""

from __future__ import annotations

import csv
import itertools
import struct
import sys
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from grader.turtlesim.turtle import FRAME_S, TIME_OUT_S
from grader.turtlesim.world import World

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.turtlesim.turtle import Rotation, State, Turtle

FIELDS = ("x", "y", "theta", "linear_velocity", "angular_velocity")
_HAIR_S = 1e-6


@dataclass(frozen=True)
class Difference:
    """The largest difference between a recorded and a computed value, in the unit of the value (m, rad, m/s, rad/s)."""

    size: float
    frame: int
    field: str


def replay(inputs: Path, poses: Path) -> Difference:
    """Replay the inputs. Return the largest difference between a computed pose (as float32) and the recorded pose."""
    worst = Difference(0.0, 0, FIELDS[0])
    for (frame, recorded), (turtle, _) in zip(_poses(poses), _frames(inputs), strict=False):
        for field, theirs, ours in zip(FIELDS, recorded, _as_published(turtle.state()), strict=True):
            size = abs(theirs - ours)
            # Do not use `size > worst.size`, because nan must count as the largest difference.
            if not size <= worst.size:
                worst = Difference(size, frame, field)
    return worst


def rotations(inputs: Path, frames: int) -> Iterator[Rotation]:
    """Replay the given number of frames, and yield the rotation after each frame in which the turtle follows a goal."""
    for _, rotation in itertools.islice(_frames(inputs), frames):
        if rotation is not None:
            yield rotation


@dataclass(frozen=True)
class _Input:
    name: str
    a: float
    b: float
    c: float


def _frames(inputs: Path) -> Iterator[tuple[Turtle, Rotation | None]]:
    """After each frame, yield turtle1 and the rotation that it had after the frame's inputs, without end."""
    world = World()
    turtle = world.turtles["turtle1"]
    by_frame = _inputs(inputs)
    now_s = 0.0
    for frame in itertools.count():
        wanted = by_frame[frame]
        for given in wanted:
            _apply(world, given)
        rotation = turtle.rotation
        now_s = _frame_time(now_s, turtle.last_command_s, timed_out=any(i.name == "timeout" for i in wanted))
        world.step(now_s)
        yield turtle, rotation


def _frame_time(before_s: float, last_command_s: float | None, *, timed_out: bool) -> float:
    """Return the time of the next frame.

    The frames of the recorded turtlesim followed the wall clock, so a time-out occurred 62 to 64 frames after the
    command. In the replay, the times of the frames are adjusted so that the last command times out in the same frame.
    """
    now_s = before_s + FRAME_S
    if last_command_s is None:
        return now_s
    deadline_s = last_command_s + TIME_OUT_S
    if timed_out:
        return max(now_s, deadline_s + _HAIR_S)
    # Until the recorded time-out, the time does not advance beyond the deadline.
    return min(now_s, max(before_s, deadline_s - _HAIR_S)) if before_s <= deadline_s else now_s


def _apply(world: World, given: _Input) -> None:
    turtle = world.turtles["turtle1"]
    match given.name:
        case "cmd_vel":
            world.command("turtle1", given.a, given.b, given.c)
        case "teleport_absolute":
            turtle.teleport_absolute(given.a, given.b, given.c)
        case "teleport_relative":
            turtle.teleport_relative(given.a, given.b)
        case "holonomic":
            world.holonomic = given.a != 0.0
        case "rotate_goal":
            turtle.rotate_to(given.a)
        case "rotate_cancel":
            if turtle.rotation is not None:
                turtle.rotation.cancel = True
        case "timeout":
            pass
        case name:
            message = f"unknown input {name!r} in a recording"
            raise ValueError(message)


def _inputs(path: Path) -> dict[int, list[_Input]]:
    by_frame: dict[int, list[_Input]] = defaultdict(list)
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            a, b, c = (float(row[key] or 0.0) for key in "abc")
            by_frame[int(row["frame"])].append(_Input(row["input"], a, b, c))
    return by_frame


def _poses(path: Path) -> Iterator[tuple[int, tuple[float, ...]]]:
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            yield int(row["frame"]), tuple(float(row[field]) for field in FIELDS)


def _as_published(state: State) -> tuple[float, ...]:
    packed = struct.pack("<5f", *state[:5])
    return struct.unpack("<5f", packed)


def main() -> None:
    """Print the largest difference for each pair of files on the command line."""
    names = [Path(name) for name in sys.argv[1:]]
    for inputs, poses in zip(names[::2], names[1::2], strict=True):
        worst = replay(inputs, poses)
        print(f"{inputs.name}: {worst.size:.3g} at frame {worst.frame} in {worst.field}")


if __name__ == "__main__":
    main()
