from __future__ import annotations

import json
from dataclasses import fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from mcap.reader import make_reader

from grader.evidence.bag import read_payloads, write_bag
from grader.ros.installation import find_ros
from grader.trial.recording import (
    Command,
    Endpoint,
    Graph,
    LogLine,
    Message,
    Output,
    Pose,
    ProcessEnd,
    Recording,
    frames_of,
)
from grader.trial.recording_json import from_json, new_to_json, to_json

if TYPE_CHECKING:
    from pathlib import Path

TWIST = b"\0\1\0\0" + np.array([2.0, 0, 0, 0, 0, 1.0]).tobytes()
TEXT = b"\0\1\0\0\3\0\0\0hi\0"

RECORDING = Recording(
    clock="wall",
    why="because",
    seed=3,
    start=Pose(1.0, 2.0, 0.5),
    duration_s=10.0,
    sigint_t_s=10.01,
    messages=(
        Message("/chatter", "std_msgs/msg/String", TEXT, -0.2, 100.0),
        Message("/turtle1/cmd_vel", "geometry_msgs/msg/Twist", TWIST, 0.512, 100.7),
        Message("/chatter", "std_msgs/msg/String", TEXT, 0.512, 100.7),
        Message("/turtle1/cmd_vel", "geometry_msgs/msg/Twist", TWIST, 0.512, 100.7),
    ),
    dropped=1,
    commands=(Command(0.512, 100.7, (2.0, 0.0, float("nan")), (0.0, 0.0, float("inf"))),),
    frames=frames_of([(0.016, 5.5, 5.5, 0.0, 2.0, 1.0, False), (0.032, 11.1, 5.5, 0.1, 2.0, 1.0, True)]),
    log=(LogLine(0.1, "WARN", "draw_circle", "text"),),
    graphs=(
        Graph(0.0, ("/draw_circle",), (Endpoint("publisher", "/draw_circle", "/chatter", "std_msgs/msg/String"),)),
    ),
    topics={"/chatter": ("std_msgs/msg/String",)},
    stdout=Output("a\nb\n", 5, (0.1, 0.2)),
    stderr=Output(""),
    end=ProcessEnd("SIGINT", -2, 10.1, 0.1),
    interventions=("reset",),
    interventions_dropped=2,
    graph_dropped=3,
    doubts=("slow",),
    seconds={"run": 1.0},
    stalls=((1.0, 1.5),),
    crowded=True,
)


def same(one: Recording, other: Recording) -> bool:
    """Return whether two recordings are equal. `==` cannot compare arrays and NaN."""
    return repr(to_json(one)) == repr(to_json(other))


def test_a_recording_survives_a_round_trip_through_json() -> None:
    assert same(from_json(json.loads(json.dumps(to_json(RECORDING)))), RECORDING)


def test_a_recording_without_its_messages_gets_them_back_from_a_bag(tmp_path: Path) -> None:
    write_bag(tmp_path / "bag", RECORDING.messages, find_ros().prefixes)
    rest = json.loads(json.dumps(to_json(RECORDING, messages=False)))
    assert same(from_json(rest, read_payloads(tmp_path / "bag")), RECORDING)


def test_the_bag_is_one_that_another_reader_opens(tmp_path: Path) -> None:
    write_bag(tmp_path / "bag", RECORDING.messages, find_ros().prefixes)
    (file,) = (tmp_path / "bag").glob("*.mcap")
    with file.open("rb") as stream:
        read = [
            (schema.name, channel.topic, message.log_time, message.data)
            for schema, channel, message in make_reader(stream).iter_messages()
            if schema is not None
        ]
    assert [(name, topic) for name, topic, _, _ in read] == [(m.type, m.topic) for m in RECORDING.messages]
    assert [data for *_, data in read] == [m.data for m in RECORDING.messages]
    assert [stamp for _, _, stamp, _ in read] == [0, 512_000_000, 512_000_001, 512_000_002]


def test_arrivals_in_a_stall_or_right_after_it_are_not_trusted() -> None:
    assert [RECORDING.stalled(t_s) for t_s in (0.99, 1.0, 1.5, 1.54, 1.6)] == [False, True, True, True, False]


@pytest.mark.parametrize("rows", [[(0.0, 1.0, 2.0, 3.0, 4.0, 5.0, True), (0.016, 1, 2, 3, 4, 5, False)], []])
def test_a_new_recording_has_the_same_json_without_numpy(rows: list[Any]) -> None:
    recording = replace(RECORDING, frames=frames_of(rows))
    values = {field.name: getattr(recording, field.name) for field in fields(recording) if field.name != "frames"}
    assert json.dumps(new_to_json(rows, **values)) == json.dumps(to_json(recording))
