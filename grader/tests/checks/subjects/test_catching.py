"""A node that drives turtle1 to the targets and requests their removal, nearest first."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.catching import CATCHES, NEAREST_FIRST, WITHIN_REACH
from grader.tests.checks.made import DURATION_S, NODE, NODE_FILE, evidence, found, recording, submission
from grader.trial.observed import Call, Track
from grader.trial.recording import Beside, Output, ProcessEnd

if TYPE_CHECKING:
    from grader.checks.outcome import Finding
    from grader.evidence.evidence import Evidence

CATCHER = NODE.replace("import rclpy\n", "import rclpy\nfrom turtlesim.srv import Kill\n").replace(
    "        self.timer",
    '        self.client = self.create_client(Kill, "/catch")\n'
    "        self.client.call_async(Kill.Request())\n        self.timer",
)
LOOP = CATCHER.replace(
    "        self.timer",
    "        for name in self.names:\n"
    "            self.create_subscription(Pose, name, lambda pose: print(name), 10)\n        self.timer",
)
AHEAD = [(0.1 * number, 0.5, 0.0) for number in range(1, 100)]
"""Commands that drive turtle1 to the right, from x=5.54 m, at 0.5 m/s."""


def at(name: str, x: float, gone_s: float | None) -> Track:
    return Track(name, ((0.0, x, 5.544445, 0.0),), gone_s)


def catch(t_s: float, name: str) -> Call:
    return Call(t_s, "/catch", "turtlesim/srv/Kill", {"name": name}, {}, t_s)


NEAR, FAR = at("near", 6.2, 1.4), at("far", 7.2, 3.4)
CALLS = (catch(1.4, "near"), catch(3.4, "far"))


def given(*tracks: Track, code: str = CATCHER, commands: Any = AHEAD, **changes: Any) -> Evidence:  # noqa: ANN401
    made = recording(commands, tracks=tracks or (NEAR, FAR), calls=changes.pop("calls", CALLS), **changes)
    return evidence(made, submission({NODE_FILE: code}))


def diagnosis(finding: Finding) -> str | None:
    return finding.diagnosis


def test_a_right_catcher_passes() -> None:
    reach = found(WITHIN_REACH, given(), service="/catch", reach_m=0.5)
    for finding in (found(CATCHES, given(), turtles=2), found(NEAREST_FIRST, given()), reach):
        assert finding.status is Status.PASSED, finding


def test_a_turtle_that_still_drives_is_too_slow() -> None:
    finding = found(CATCHES, given(NEAR, at("far", 5.0, None)))
    assert diagnosis(finding) == "too-slow"


def test_a_turtle_that_stands_is_named() -> None:
    assert diagnosis(found(CATCHES, given(NEAR, at("far", 2.0, None), commands=AHEAD[:14]))) == "stands-still"
    still = [(0.1 * number, 0.0, 0.0) for number in range(1, 100)]
    assert diagnosis(found(CATCHES, given(at("far", 2.0, None), commands=still, calls=()))) == "never-drives"


def test_a_function_made_in_a_loop_is_named() -> None:
    assert diagnosis(found(CATCHES, given(NEAR, at("far", 2.0, None), code=LOOP))) == "loop-variable"
    right = LOOP.replace("lambda pose:", "lambda pose, name=name:")
    assert diagnosis(found(CATCHES, given(NEAR, at("far", 2.0, None), code=right))) == "too-slow"


def test_another_name_is_named() -> None:
    assert diagnosis(found(CATCHES, given(at("far", 2.0, None), calls=(catch(1.0, "turtle1"),)))) == "target-name"


def test_the_end_of_the_other_node_is_named() -> None:
    ended = ProcessEnd("itself", 0, 2.0, None)
    beside = (Beside("spawner", Output(""), Output(""), ended),)
    finding = found(CATCHES, given(NEAR, at("far", 2.0, None), beside=beside))
    assert diagnosis(finding) == "other-node-ended"


@pytest.mark.parametrize(
    ("calls", "text"),
    [
        (CALLS, None),
        (CALLS[:1], "Remove a target only"),
        ((*CALLS[:1], catch(5.0, "far")), "Remove a target only"),
        ((*CALLS[:1], Call(3.3, "/kill", "turtlesim/srv/Kill", {"name": "far"}, {}, 3.3)), "/kill was called for far"),
        ((*CALLS[:1], Call(3.3, "/reset", "std_srvs/srv/Empty", {}, {}, 3.3)), "/reset was called"),
    ],
)
def test_a_target_that_the_referee_removed_by_itself_is_not_caught(calls: tuple[Call, ...], text: str | None) -> None:
    finding = found(CATCHES, given(calls=calls), turtles=2, service="/catch")
    assert diagnosis(finding) == (text and "killed-uncaught")
    assert not text or finding.cause.startswith(text)


def test_a_teleport_is_not_driving() -> None:
    jumped = given(interventions=("teleport_absolute",))
    frames = jumped.recording.frames
    moved = replace(frames, x=frames.x + (frames.t_s > 2.0))
    finding = found(CATCHES, given(interventions=("teleport_absolute",), frames=moved))
    assert diagnosis(finding) == "not-driven"


def test_the_farther_one_first_is_named() -> None:
    finding = found(NEAREST_FIRST, given(at("near", 6.5, 9.0), at("far", 9.0, 3.4)))
    assert diagnosis(finding) == "other-order"


@pytest.mark.parametrize(
    ("calls", "expected"),
    [
        ((catch(0.1, "near"), catch(3.4, "far")), "from-afar"),
        ((*(catch(1.3 + 0.01 * number, "near") for number in range(5)), catch(3.4, "far")), "catch-again"),
        ((catch(1.4, "near"), catch(3.4, "turtle1")), "target-name"),
    ],
)
def test_wrong_calls_are_named(calls: tuple[Call, ...], expected: str) -> None:
    assert diagnosis(found(WITHIN_REACH, given(calls=calls), service="/catch", reach_m=0.5)) == expected


def test_the_targets_count_that_were_caught_before_the_end() -> None:
    late = at("late", 9.0, DURATION_S + 1.0)
    assert found(CATCHES, given(NEAR, late)).status is Status.FAILED
