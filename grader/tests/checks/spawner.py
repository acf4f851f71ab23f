"""A made-up trial of a node that spawns turtles, announces the remaining turtles, and removes the caught turtles."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

from grader.tests.checks.made import DURATION_S, NODE, NODE_FILE, evidence, recording, submission
from grader.trial.observed import Call, Track
from grader.trial.recording import Message

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

SPAWNER = NODE.replace("import rclpy\n", "import rclpy\nfrom turtlesim.srv import Kill\n").replace(
    "        self.timer",
    '        self.create_service(Kill, "/catch", self.send)\n'
    '        self.killer = self.create_client(Kill, "/kill")\n'
    "        self.killer.call_async(Kill.Request())\n        self.timer",
)
PLACES = {"target1": (2.0, 3.0), "target2": (7.5, 4.0), "target3": (5.0, 9.0)}
CAUGHT_S = 5.0


def spawn(t_s: float, name: str, x: float, y: float, **changes: Any) -> Call:  # noqa: ANN401
    request = {"x": x, "y": y, "theta": 0.0, "name": name}
    return Call(t_s, "/spawn", "turtlesim/srv/Spawn", request, changes.get("response", {"name": name}), t_s)


def catch(name: str = "target2") -> Call:
    return Call(CAUGHT_S, "/catch", "turtlesim/srv/Kill", {"name": name}, {}, CAUGHT_S, by_trial=True)


def kill(name: str = "target2") -> Call:
    return Call(CAUGHT_S, "/kill", "turtlesim/srv/Kill", {"name": name}, {}, CAUGHT_S)


def said(t_s: float, text: str) -> Message:
    data = b"\0\1\0\0" + struct.pack("<I", len(text.encode()) + 1) + text.encode() + b"\0"
    return Message("/targets", "std_msgs/msg/String", data, t_s, t_s)


def names_at(t_s: float) -> str:
    return " ".join(name for name in PLACES if t_s < CAUGHT_S or name != "target2")


def given(**changes: Any) -> Evidence:  # noqa: ANN401
    """Return the evidence of a correct spawner, with these changes."""
    calls = changes.pop("calls", [spawn(0.5, name, *place) for name, place in PLACES.items()] + [catch(), kill()])
    gone = changes.pop("gone", {"target2": CAUGHT_S})
    tracks = tuple(Track(name, ((0.5, *place, 0.0),), gone.get(name)) for name, place in PLACES.items())
    times = [1.0 + 0.5 * number for number in range(int(2 * DURATION_S) - 2)]
    messages = tuple(said(t_s, changes.pop("text", None) or names_at(t_s)) for t_s in times[:1])
    messages += tuple(said(t_s, names_at(t_s)) for t_s in times[1:])
    messages = changes.pop("messages", messages)
    made = recording([], calls=tuple(calls), tracks=tracks, messages=messages, **changes)
    return evidence(made, submission({NODE_FILE: SPAWNER}))
