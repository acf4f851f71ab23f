"""A node forgets a target that is no longer announced."""

from __future__ import annotations

import struct

import pytest

from grader.checks.outcome import Finding, Status
from grader.checks.subjects.forgetting import FORGETS
from grader.tests.checks.made import NODE, NODE_FILE, evidence, found, recording, submission
from grader.trial.observed import Call, Track
from grader.trial.recording import Message

CATCHER = NODE.replace(
    "        self.timer", '        self.create_subscription(String, "/targets", self.names, 10)\n        self.timer'
)
TRACKS = tuple(
    Track(name, ((0.0, x, 5.0, 0.0),), gone_s) for name, x, gone_s in (("ada", 6.0, 2.0), ("bela", 8.0, 2.0))
)


def names(t_s: float, text: str) -> Message:
    data = b"\0\1\0\0" + struct.pack("<I", len(text) + 1) + text.encode() + b"\0"
    return Message("/targets", "std_msgs/msg/String", data, t_s, t_s)


def finding(call_s: float, name: str = "bela", withdrawn: tuple[str, ...] = ("bela",)) -> Finding:
    calls = tuple(
        Call(t_s, "/catch", "turtlesim/srv/Kill", {"name": each}) for t_s, each in ((2.0, "ada"), (call_s, name))
    )
    messages = (names(1.9, "ada bela"), names(2.4, ""), names(2.9, ""))
    made = recording((), tracks=TRACKS, calls=calls, messages=messages, withdrawn=withdrawn)
    return found(FORGETS, evidence(made, submission({NODE_FILE: CATCHER})), topic="/targets", service="/catch")


def test_a_call_for_a_target_that_is_no_longer_announced_is_reported() -> None:
    found_late = finding(4.0)
    assert (found_late.status, found_late.diagnosis) == (Status.FAILED, "not-forgotten")
    assert found_late.observed == (
        "From 2.4 s on, /targets did not contain bela. At 4.0 s, the node called /catch for bela."
    )
    assert str(found_late.where) == f"{NODE_FILE}:10"


@pytest.mark.parametrize("call_s", [1.5, 2.3, 2.6])
def test_a_node_may_call_until_it_has_received_the_announcement(call_s: float) -> None:
    assert finding(call_s).status is Status.PASSED


def test_only_the_withdrawn_target_counts() -> None:
    assert finding(4.0, name="ada").status is Status.PASSED
    assert finding(4.0, withdrawn=()).status is Status.PASSED
