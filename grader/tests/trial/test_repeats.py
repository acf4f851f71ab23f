"""Each message is recorded once, although both the simulator and the recorder receive the messages of other turtles."""

from __future__ import annotations

import struct
from collections import Counter
from typing import TYPE_CHECKING

import pytest

from grader.tests.trial.test_node_group import trial_of
from grader.trial.inputs import Inputs
from grader.trial.repeats import Repeats

if TYPE_CHECKING:
    from grader.trial.recording import Message, Recording

DURATION_S = 4.0
COMMANDS, POSE, COLOR = "/turtle2/cmd_vel", "/turtle2/pose", "/turtle2/color_sensor"
SPAWNS = """
from geometry_msgs.msg import Twist
from turtlesim.srv import Spawn
commands = node.create_publisher(Twist, "/turtle2/cmd_vel", {qos})
spawner = node.create_client(Spawn, "/spawn")
def spawn():
    once.cancel()
    spawner.call_async(Spawn.Request(x=2.0, y=2.0, name="turtle2"))
once = node.create_timer({spawn_s}, spawn)
def drive():
    commands.publish(Twist())
    print("sent", flush=True)
node.create_timer(0.1, drive)
"""
PUBLISHES_POSES = """
from turtlesim.msg import Color, Pose
poses = {topic: node.create_publisher(Pose, topic, 10) for topic in ("/turtle1/pose", "/turtle2/pose")}
colors = node.create_publisher(Color, "/turtle2/color_sensor", 10)
def tell():
    for topic in poses:
        poses[topic].publish(Pose(x=-1.0))
    colors.publish(Color(r=69, g=86, b=255))  # like the messages of the simulator
    print("told", flush=True)
node.create_timer(0.5, tell)
"""
BEST_EFFORT = "rclpy.qos.qos_profile_sensor_data"


def spawns(spawn_s: float = 1.0, qos: str = "10") -> str:
    """Return a node that spawns turtle2 at this time (s), and sends it a command each 0.1 s."""
    return SPAWNS.format(spawn_s=spawn_s, qos=qos)


def sent(recording: Recording, topic: str) -> list[Message]:
    """Return the recorded messages on the topic."""
    return [message for message in recording.messages if message.topic == topic]


def frames_from(begin_s: float, recording: Recording) -> list[float]:
    """Return the times from `begin_s` (s) at which the simulator published the colour of turtle1, once per frame."""
    return [message.t_s for message in sent(recording, "/turtle1/color_sensor") if message.t_s >= begin_s]


@pytest.mark.parametrize("qos", ["10", BEST_EFFORT])
def test_a_command_of_another_turtle_is_recorded_once(qos: str) -> None:
    recording = trial_of(Inputs(), DURATION_S, spawns=spawns(qos=qos))
    assert "turtle2" in {track.turtle for track in recording.tracks}
    assert len(sent(recording, COMMANDS)) == recording.stdout.text.count("sent") > 30


def test_a_pose_and_a_color_of_another_turtle_are_recorded_once() -> None:
    recording = trial_of(Inputs(), DURATION_S, spawns=spawns())
    for topic in (POSE, COLOR):
        times = [message.t_s for message in sent(recording, topic)]
        assert times == frames_from(times[0], recording)
        assert len(times) > 100


def test_messages_of_another_node_on_the_topics_of_the_simulator_are_recorded_once() -> None:
    recording = trial_of(Inputs(), DURATION_S, spawns=spawns(), tells=PUBLISHES_POSES)
    told = recording.seen_from("tells").stdout.text.count("told")
    for topic in ("/turtle1/pose", POSE):
        of_node = [message for message in sent(recording, topic) if message.data[4:8] == struct.pack("<f", -1.0)]
        others = [message.t_s for message in sent(recording, topic) if message not in of_node]
        assert len(of_node) == told > 5
        assert others == frames_from(others[0], recording)
    assert len(sent(recording, COLOR)) == len(sent(recording, POSE))


def test_the_larger_of_the_two_counts_is_recorded() -> None:
    for order in ("SRSR", "RSRS", "SSRR", "RRSS", "SRRS", "RR", "SS"):
        repeats, recorded = Repeats(), Counter[bytes]()
        for reporter in order:
            by_simulator = reporter == "S"
            if not repeats.is_repeat(POSE, b"data", by_simulator=by_simulator):
                repeats.add(POSE, b"data", by_simulator=by_simulator)
                recorded[b"data"] += 1
            assert not repeats.is_repeat(POSE, b"other", by_simulator=by_simulator)
        assert recorded[b"data"] == 2, order
