"""Call the functions and programs of a trial without a simulator, with the inputs of exercise.toml."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

from grader.common.temporary_folder import temporary_folder
from grader.grading.plan import DEFAULT_SEED
from grader.submission.reader import read
from grader.trial.called import read_called
from grader.trial.calling import make_calls
from grader.trial.recording import Message

if TYPE_CHECKING:
    from grader.exercise.call_inputs import BagInput, PointsInput
    from grader.exercise.model import TrialSpec
    from grader.ros.installation import Ros
    from grader.trial.called import Called

_POSE = struct.Struct("<xBxx5f")
_TWIST = struct.Struct("<xBxx6d")
_LITTLE_ENDIAN = 1
"""The second byte of serialized data whose byte order is little-endian."""
_LATE = 0.25
"""The delay of every second pose, as a fraction of the period."""
_SPEED_M_S = 1.0


def call(
    spec: TrialSpec, ros: Ros, package: str, tree: bytes, *, seed: int | None, in_cell: bool
) -> tuple[Called, ...]:
    """Make the calls of this trial with the package in this install tree (a tar stream).

    The random noise depends on `seed`.

    Raises:
        MachineError: no call could be made, for example because the sandbox does not work.
        UnreadableError: the output of the calls could not be read.
    """
    drawn = DEFAULT_SEED if seed is None else seed
    calls = spec.calls
    files: dict[str, bytes] = {}
    for bag in calls.bags:
        files |= _bag_files(bag, ros, drawn)
    output = make_calls(
        ros,
        package,
        tree,
        [*(_points(each, drawn) for each in calls.points), *(_run(each) for each in calls.bags)],
        files,
        function=calls.function,
        executable=spec.executable,
        in_cell=in_cell,
    )
    return read(read_called, output, calls.ids)


def _points(given: PointsInput, seed: int) -> dict[str, Any]:
    x, y = (list(given.x), list(given.y))
    if given.arc is not None:
        x, y = (each.tolist() for each in given.arc.points(given.id, seed))
    return {"id": given.id, "x": x, "y": y, "lists": given.lists}


def _run(bag: BagInput) -> dict[str, Any]:
    return {"id": bag.id, "arguments": [f"bags/{bag.id}"]}


def _bag_files(bag: BagInput, ros: Ros, seed: int) -> dict[str, bytes]:
    """Return the files of the bag by their paths."""
    from grader.evidence.bag import write_bag  # rosbags takes 0.1 s to import, and most exercises do not need it

    with temporary_folder() as made:
        folder = made / bag.id
        write_bag(folder, _messages(bag, seed), ros.all_prefixes)
        return {f"bags/{bag.id}/{file.name}": file.read_bytes() for file in sorted(folder.iterdir())}


def _messages(bag: BagInput, seed: int) -> list[Message]:
    """Return the poses and the commands in chronological order. The time stamp of the first pose is 1 s."""
    x, y = bag.arc.points(bag.id, seed)
    messages = [
        _message("/turtle1/pose", "turtlesim/msg/Pose", _stamp_s(index, bag), _POSE, *values, 0.0, _SPEED_M_S, 0.0)
        for index, values in enumerate(zip(x.tolist(), y.tolist(), strict=True) if bag.poses else ())
    ]
    last_s = max(bag.arc.count - 1, 1) / bag.rate_hz
    messages += [
        _message(
            "/turtle1/cmd_vel",
            "geometry_msgs/msg/Twist",
            1.0 + last_s * (index + 0.5) / bag.commands,
            _TWIST,
            _SPEED_M_S,
            0.0,
            0.0,
            0.0,
            0.0,
            _SPEED_M_S / bag.arc.radius_m,
        )
        for index in range(bag.commands)
    ]
    return sorted(messages, key=lambda message: message.t_s)


def _stamp_s(index: int, bag: BagInput) -> float:
    """Return the time stamp of a pose.

    Every second pose is late, as in a recording, but not the last one. So the mean rate is `rate_hz`, but the interval
    between two poses does not show it.
    """
    late = _LATE if index % 2 and index < bag.arc.count - 1 else 0.0
    return 1.0 + (index + late) / bag.rate_hz


def _message(topic: str, kind: str, t_s: float, form: struct.Struct, *values: float) -> Message:
    return Message(topic, kind, form.pack(_LITTLE_ENDIAN, *values), t_s, t_s)
