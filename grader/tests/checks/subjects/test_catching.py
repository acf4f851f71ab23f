"""A node that drives turtle1 to the targets and requests their removal, nearest first."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.catching import CATCHES, NEAREST_FIRST, WAITS_FOR_POSE, WITHIN_REACH
from grader.tests.checks.made import DURATION_S, NODE, NODE_FILE, evidence, found, recording, submission
from grader.tests.checks.told import told
from grader.trial.observed import Call, Track
from grader.trial.recording import Beside, Output, ProcessEnd

if TYPE_CHECKING:
    from grader.checks.outcome import Finding
    from grader.evidence.evidence import Evidence
    from grader.trial.recording import Recording

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
    assert (finding.diagnosis, finding.expected) == (
        "other-order",
        "The next target is always the one nearest to turtle1.",
    )


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


def test_the_targets_count_that_were_caught_before_the_end_or_withdrawn_by_the_trial() -> None:
    assert found(CATCHES, given(NEAR, at("late", 9.0, DURATION_S + 1.0))).status is Status.FAILED
    two, three = (found(CATCHES, given(NEAR, at("far", 9.0, 1.4), withdrawn=("far",)), turtles=each) for each in (2, 3))
    assert (two.status, three.status) == (Status.PASSED, Status.FAILED)
    assert two.observed == "All remaining targets were caught, the last one at 1 s."


WESTERN = at("far", 2.0, None)


def about(*tracks: Track, turtles: float = 2, **changes: Any) -> str:  # noqa: ANN401
    return told(found(CATCHES, given(*tracks, **changes), turtles=turtles))


def kill(name: str) -> Call:
    return Call(3.3, "/kill", "turtlesim/srv/Kill", {"name": name}, {}, 3.3)


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("All 2 targets were caught, the last one at 3 s.", (NEAR, FAR), (NEAR, WESTERN)),
        ("All targets are caught within 10 s, and turtle1 moves only by driving.", (NEAR, WESTERN), (NEAR, FAR)),
        ("1 of 2 targets was caught.", (NEAR, WESTERN), (NEAR, FAR)),
        ("1 of 2 targets appeared.", (NEAR,), (NEAR, WESTERN)),
    ],
)
def test_a_sentence_about_the_caught_targets_is_true(
    words: str, true: tuple[Track, ...], near: tuple[Track, ...]
) -> None:
    assert words in about(*true)
    assert words not in about(*near)


@pytest.mark.parametrize(
    ("name", "targets", "killed", "called"),
    [("far", 2, True, False), ("mouse", 2, False, True), ("far", 0, False, False)],
)
def test_a_catcher_must_not_kill(name: str, targets: int, *, killed: bool, called: bool) -> None:
    made = given(calls=(*CALLS, kill(name)), interventions=("kill",))
    trials = tuple(replace(each, scenario=replace(each.scenario, targets=targets)) for each in made.exercise.trials)
    made = replace(made, exercise=replace(made.exercise, trials=trials))
    reported = told(found(CATCHES, made))
    assert ("The node removed a target itself, with /kill." in reported) == killed
    assert ("The node called /kill." in reported) == called
    assert ("Only the spawner may remove a target. Call its service /catch." in reported) == (killed or called)


@pytest.mark.parametrize(("calls", "found"), [(CALLS[:1], True), (CALLS, False)])
def test_a_target_that_nobody_caught_is_told(calls: tuple[Call, ...], *, found: bool) -> None:
    assert ("far was removed at 3.4 s, although nobody caught it." in about_service(calls)) == found


def about_service(calls: tuple[Call, ...]) -> str:
    return told(found(CATCHES, given(calls=calls), service="/catch"))


@pytest.mark.parametrize(("moved", "found"), [(True, True), (False, False)])
def test_a_turtle_that_did_not_drive_is_told(moved: bool, *, found: bool) -> None:
    made = recording(AHEAD, tracks=(NEAR, FAR), calls=CALLS, interventions=("teleport_absolute",))
    frames = replace(made.frames, x=made.frames.x + 1.0 * (made.frames.t_s > 2.0)) if moved else made.frames
    reported = told(found_in(replace(made, frames=frames)))
    assert ("The node moved the turtle with teleport_absolute." in reported) == found
    assert ("The turtle must drive to each target: publish on /turtle1/cmd_vel." in reported) == found


def found_in(trial: Recording) -> Finding:
    return found(CATCHES, evidence(trial, submission({NODE_FILE: CATCHER})))


def about_order(*tracks: Track) -> str:
    return told(found(NEAREST_FIRST, given(*tracks)))


@pytest.mark.parametrize(("tracks", "only"), [((NEAR,), True), ((NEAR, FAR), False)])
def test_a_single_target_is_described_in_the_singular(tracks: tuple[Track, ...], *, only: bool) -> None:
    assert ("The only target was caught at 1 s." in about(*tracks, turtles=1)) == only
    assert ("1 target was caught, the nearest first." in about_order(*tracks)) == only


B_FIRST = (at("a", 6.5, 9.0), at("b", 9.0, 3.4))
LATER = Track("b", ((3.0, 9.0, 5.544445, 0.0),), 3.4)


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("2 targets were caught, the nearest first.", (NEAR, FAR), B_FIRST),
        ("No target was caught.", (at("a", 6.5, None),), (NEAR,)),
        ("The next target is always the one nearest to turtle1.", B_FIRST, (NEAR, FAR)),
        ("At 0.0 s, a was 1.0 m away and b 3.5 m, but b was caught first.", B_FIRST, (B_FIRST[0], LATER)),
        ("The first target was the farthest one.", B_FIRST, (*B_FIRST, at("c", 1.0, None))),
        ("After each catch, compute the distance from turtle1", (*B_FIRST, at("c", 1.0, None)), B_FIRST),
        (
            "The targets were caught in the order of their names.",
            (at("a", 9.0, 3.4), at("b", 6.5, 9.0)),
            (at("a", 9.0, 3.4), at("b", 6.5, None), at("c", 1.0, None)),
        ),
        (
            "The targets were caught in the order of their distances from the start.",
            (at("b", 6.5, 1.4), at("a", 3.0, 2.4), at("c", 8.5, None)),
            B_FIRST,
        ),
    ],
)
def test_a_sentence_about_the_order_is_true(words: str, true: tuple[Track, ...], near: tuple[Track, ...]) -> None:
    assert words in about_order(*true)
    assert words not in about_order(*near)


def about_reach(*calls: Call, tracks: tuple[Track, ...] = ()) -> str:
    return told(found(WITHIN_REACH, given(*tracks, calls=calls), service="/catch", reach_m=0.5))


OFTEN = tuple(catch(1.3 + 0.01 * number, "near") for number in range(5))


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("Each time the node called /catch, the target was near.", CALLS, ()),
        ("The node never called /catch.", (), CALLS[:1]),
        ("When the node called /catch for near, this turtle was 0.65 m away.", (catch(0.1, "near"),), CALLS[:1]),
        ("The node calls /catch when the target is at most 0.5 m away.", (catch(0.1, "near"),), CALLS),
        ('The node called /catch with the name "mouse".', (catch(1.4, "mouse"),), CALLS[:1]),
        ("The targets were far and near. The name is a field of the request.", (catch(1.4, "mouse"),), OFTEN),
        ("The node called /catch for near repeatedly.", OFTEN, OFTEN[:3]),
        ("One call is enough.", OFTEN, OFTEN[:3]),
        (
            "Store in an attribute whether the node is waiting for a response. While it is waiting, do not call again.",
            OFTEN,
            OFTEN[:3],
        ),
    ],
)
def test_a_sentence_about_the_reach_is_true(words: str, true: tuple[Call, ...], near: tuple[Call, ...]) -> None:
    assert words in about_reach(*true)
    assert words not in about_reach(*near)


def test_a_turtle_that_is_gone_is_not_far_away() -> None:
    late = (*CALLS, catch(9.0, "near"))
    assert "this turtle was" not in about_reach(*late)
    assert "this turtle was 3.8" in about_reach(*late, tracks=(at("near", 6.2, None), FAR))


@pytest.mark.parametrize(
    ("commands", "early_s"),
    [
        (AHEAD, 0.1),
        ([(1.9, 0.0, -0.5), *AHEAD[25:]], 1.9),
        ([(0.1, 0.0, 0.0), *AHEAD[25:]], None),
    ],
)
def test_turtle1_stands_still_until_its_first_pose(commands: list[tuple[float, ...]], early_s: float | None) -> None:
    made = given(commands=commands)
    late = replace(made.trial, scenario=replace(made.trial.scenario, pose_from_s=2.0))
    finding = found(WAITS_FOR_POSE, replace(made, exercise=replace(made.exercise, trials=(late,))))
    reported, fails = told(finding), early_s is not None
    assert diagnosis(finding) == ("drives-before-pose" if fails else None)
    assert ("The turtle stood still until its first pose arrived." in reported) == (not fails)
    drove = f"The node drove the turtle at {early_s} s. The first pose of turtle1 arrived at 2.0 s."
    assert (drove in reported) == fails
    assert ("Until the first pose of turtle1 arrives, the turtle stands still." in reported) == fails
    unknown = "Before the first pose, the position of turtle1 is unknown. Store None until the first pose arrives."
    assert (unknown in reported) == fails
