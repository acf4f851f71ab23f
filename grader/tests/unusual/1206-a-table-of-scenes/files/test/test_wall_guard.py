"""Each line of the table is a scene: the places of the turtle with ticks between them, and the commands after it."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from guard_bench import commands_after

AHEAD, LEFT, STOP = (1.1, 0.0), (0.5, 1.2), (0.0, 0.0)
MIDDLE = (5.5, 5.5)

SCENES = {
    "no pose, no command": ((8,), []),
    "ten commands a second": ((MIDDLE, 10), [AHEAD] * 10),
    "left wall": (((0.4, 5.0), 2), [LEFT] * 2),
    "right wall": (((10.6, 5.0), 2), [LEFT] * 2),
    "lower wall": (((5.0, 0.4), 2), [LEFT] * 2),
    "upper wall": (((5.0, 10.6), 2), [LEFT] * 2),
    "just far enough": (((1.1, 5.0), 2), [AHEAD] * 2),
    "there and back": ((MIDDLE, 2, (0.4, 5.0), 2, MIDDLE, 2), [AHEAD] * 2 + [LEFT] * 2 + [AHEAD] * 2),
    "the poses end": ((MIDDLE, 11, 2, 2), [AHEAD] * 12 + [STOP] * 3),
}


@pytest.mark.parametrize(("scene", "expected"), SCENES.values(), ids=SCENES)
def test_a_scene(scene, expected):
    commands = commands_after(*scene)
    assert len(commands) == len(expected)
    for command, wanted in zip(commands, expected):
        assert command == pytest.approx(wanted)
