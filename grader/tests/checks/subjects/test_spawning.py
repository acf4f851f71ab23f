"""A node that spawns turtles, announces the remaining turtles, and removes the turtles that were caught."""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.announcing import ANNOUNCES
from grader.checks.subjects.spawning import PLACES_DIFFER, REMOVES, SPAWNS
from grader.tests.checks.made import DURATION_S, NODE, NODE_FILE, evidence, found, recording, submission
from grader.trial.observed import Call, Track
from grader.trial.recording import Message

if TYPE_CHECKING:
    from grader.checks.outcome import Finding
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


def of_spawns(given: Evidence) -> Finding:
    return found(SPAWNS, given, turtles=3)


def of_announces(given: Evidence) -> Finding:
    return found(ANNOUNCES, given, topic="/targets")


def of_removes(given: Evidence) -> Finding:
    return found(REMOVES, given, service="/catch", type="turtlesim/srv/Kill", topic="/targets")


def diagnosis(finding: Finding) -> str | None:
    return finding.diagnosis


def test_a_right_spawner_passes() -> None:
    for finding in (of_spawns(given()), of_announces(given()), of_removes(given())):
        assert finding.status is Status.PASSED, finding


@pytest.mark.parametrize(
    ("calls", "expected"),
    [
        ([spawn(0.5, "target1", 2.0, 3.0)], "target-count"),
        ([spawn(0.5, f"target{number}", 2.0, number) for number in range(1, 5)], "target-count"),
        ([spawn(0.5, "", 2.0, 3.0, response={"name": "turtle2"})], "target-name"),
        ([spawn(0.5, name, 0.0, 0.0) for name in PLACES], "target-place"),
        ([spawn(0.5, name, 3.0, 4.0) for name in PLACES], "target-place"),
        ([spawn(0.5, name, 3.0, 10.5) for name in PLACES], "target-place"),
    ],
)
def test_wrong_numbers_names_and_places_are_named(calls: list[Call], expected: str) -> None:
    assert diagnosis(of_spawns(given(calls=calls))) == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("target1, target2, target3", "target-format"),
        ("target1 target2 target3 mouse", "still-announced"),
        ("target1", "target-unannounced"),
    ],
)
def test_wrong_announcements_are_named(text: str, expected: str) -> None:
    messages = (*(said(2.0 + 0.5 * number, names_at(2.0 + 0.5 * number)) for number in range(16)), said(2.1, text))
    assert diagnosis(of_announces(given(messages=messages))) == expected


def test_a_turtle_that_was_caught_is_no_longer_announced() -> None:
    every = tuple(said(1.0 + 0.5 * number, " ".join(PLACES)) for number in range(18))
    assert diagnosis(of_announces(given(messages=every))) == "still-announced"


def test_a_turtle_that_the_node_has_asked_to_remove_need_not_be_announced() -> None:
    late_s = CAUGHT_S + 0.4
    early = tuple(said(t_s, "target1" if t_s > CAUGHT_S else " ".join(PLACES)) for t_s in (1.0, 1.5, late_s - 0.2))
    gone = {"target2": late_s, "target3": late_s}
    asked = of_announces(given(calls=[catch(), kill("target3")], gone=gone, messages=early))
    assert diagnosis(asked) != "target-unannounced"
    assert diagnosis(of_announces(given(calls=[catch()], gone=gone, messages=early))) == "target-unannounced"


def test_a_turtle_is_announced_again_and_again() -> None:
    once = (said(1.0, names_at(1.0)), said(CAUGHT_S, names_at(CAUGHT_S)))
    assert diagnosis(of_announces(given(messages=once))) == "timer-period"


@pytest.mark.parametrize(
    ("calls", "gone"),
    [([catch()], {}), ([catch(), kill("")], {}), ([catch(), kill("target3")], {"target3": CAUGHT_S})],
)
def test_who_was_caught_must_be_removed_and_nobody_else(calls: list[Call], gone: dict[str, float]) -> None:
    assert diagnosis(of_removes(given(calls=calls, gone=gone))) == "not-killed"


def test_who_was_not_caught_must_stay() -> None:
    removed = of_removes(
        given(calls=[catch(), kill("target2"), kill("target3")], gone={"target2": CAUGHT_S, "target3": CAUGHT_S})
    )
    assert diagnosis(removed) == "killed-uncaught"
    assert removed.cause.startswith("/kill was called for target3")


def test_places_that_are_the_same_each_time_are_not_random() -> None:
    twice = given()
    finding = found(PLACES_DIFFER, twice, other=twice.trial.id)
    assert diagnosis(finding) == "target-place"
    assert "x=2.00, y=3.00 both times" in finding.observed
    assert found(PLACES_DIFFER, given(calls=[]), other=twice.trial.id).status is Status.PASSED
