"""The reasons why a target was not caught, each with a trial that differs in one thing."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.causes.why_not_caught import loop_variable, targets_were, why_not_caught
from grader.checks.exercises import find_exercise
from grader.evidence.evidence import Evidence, Run
from grader.submission.package import open_submission
from grader.tests.case import ROOT
from grader.tests.checks.made import NODE, NODE_FILE, evidence, graph, recording, submission
from grader.trial.observed import Call, Track
from grader.trial.recording import Beside, Endpoint, Output, ProcessEnd

if TYPE_CHECKING:
    from grader.tests.checks.made import Timed

CATCHER = NODE.replace(
    "        self.timer",
    '        self.client = self.create_client(Kill, "/catch")\n'
    "        self.client.call_async(Kill.Request())\n        self.timer",
)
AHEAD: list[Timed] = [(0.1 * number, 0.5, 0.0) for number in range(1, 100)]
"""Commands that drive turtle1 to the right, from x=5.54 m, at 0.5 m/s."""


def cause(commands: list[Timed], x: float = 9.0, from_s: float = 0.0, **changes: Any) -> str:  # noqa: ANN401
    far = Track("far", ((from_s, x, 5.544445, 0.0),), None)
    poses = Endpoint("subscription", "/draw_circle", "/far/pose", "turtlesim/msg/Pose")
    seen = graph()
    changes.setdefault("graphs", (replace(seen, endpoints=(*seen.endpoints, poses)),))
    trial = recording(commands, tracks=(far, *changes.pop("tracks", ())), **changes)
    return why_not_caught(evidence(trial, submission({NODE_FILE: CATCHER})), [far]).text


def catch(name: str) -> Call:
    return Call(1.0, "/catch", "turtlesim/srv/Kill", {"name": name}, {}, 1.0)


def speed(linear: float, angular: float) -> list[Timed]:
    return [(t_s, linear, angular) for t_s, _, _ in AHEAD]


@pytest.mark.parametrize(
    ("commands", "words"),
    [
        (speed(0.0, 0.0), "All commands that arrived contained only zeros."),
        (speed(0.0, 1.0), "linear.x is 0 in every command, so the turtle only turns."),
        (speed(0.5, 0.0), "The turtle was still moving in the last 3 s of the trial. The turtle came within"),
    ],
)
def test_what_the_commands_contain_is_told(commands: list[Timed], words: str) -> None:
    assert cause(commands).startswith(words)
    others = {"All commands that arrived", "linear.x is 0 in every", "The turtle was still moving"}
    assert [each for each in others if each in cause(commands)] == [each for each in others if each in words]


def test_a_turtle_that_stays_despite_its_commands_is_told() -> None:
    still = recording([]).frames
    words = "Commands arrived, but the turtle stayed where it was."
    assert (cause(AHEAD, frames=still) == words, cause(speed(0.0, 1.0)) != words) == (True, True)


@pytest.mark.parametrize(("from_s", "near"), [(0.0, "0.0 m"), (5.0, "1.5 m"), (20.0, None)])
def test_the_way_to_a_target_counts_while_the_target_exists(from_s: float, near: str | None) -> None:
    said = cause(AHEAD, 6.5, from_s)
    assert (" The turtle came within" not in said) == (near is None)
    assert near is None or said.endswith(f" The turtle came within {near} of far.")


@pytest.mark.parametrize(("name", "found"), [("turtle1", True), ("far", False)])
def test_a_name_that_no_target_has_is_told(name: str, *, found: bool) -> None:
    said = cause(AHEAD, calls=(catch(name),))
    assert (said == 'The node called /catch with the name "turtle1". The target was far.') == found


def test_the_sentences_hold_without_any_target() -> None:
    poses = Endpoint("subscription", "/draw_circle", "/far/pose", "turtlesim/msg/Pose")
    graphs = (replace(graph(), endpoints=(*graph().endpoints, poses)),)
    code = submission({NODE_FILE: CATCHER})
    named = why_not_caught(evidence(recording(AHEAD, calls=(catch("far"),)), code), []).text
    assert named == 'The node called /catch with the name "far". No target existed.'
    still = why_not_caught(evidence(recording(speed(0.0, 0.0), graphs=graphs), code), []).text
    assert still == "The node subscribes to /far/pose, but not to the pose of a target."


@pytest.mark.parametrize(
    ("names", "words"),
    [((), "No target existed."), (("a",), "The target was a."), (("b", "a"), "The targets were a and b.")],
)
def test_any_number_of_targets_is_listed(names: tuple[str, ...], words: str) -> None:
    assert targets_were(names) == words


@pytest.mark.parametrize(("x", "found"), [(6.4, True), (9.0, False)])
def test_a_turtle_stands_beside_a_target_or_far_from_all(x: float, *, found: bool) -> None:
    said = cause(AHEAD[:14], x, calls=(catch("far"),))
    assert (said == "The turtle stood beside far at the end.") == found
    assert found or said.startswith("The turtle stood still at the end.")


@pytest.mark.parametrize(("by", "found"), [("itself", True), ("SIGINT", False)])
def test_the_end_of_the_other_node_ends_the_trial(by: Any, *, found: bool) -> None:  # noqa: ANN401
    beside = (Beside("spawner", Output(""), Output(""), ProcessEnd(by, 0, 2.0, None)),)
    said = cause(AHEAD, beside=beside, sigint_t_s=2.0)
    assert (said == "spawner exited before all targets were caught, so the trial ended.") == found


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, "The turtle was near a target before /catch existed, and no call arrived later."),
        ({"catch_from_s": 0.0}, "The turtle stood beside far at the end."),
        ({"catch_from_s": 1.5}, "The turtle stood beside far at the end."),
        ({"calls": (catch("far"),)}, "The turtle stood beside far at the end."),
    ],
)
def test_a_call_before_the_service_existed_is_told(changes: dict[str, Any], words: str) -> None:
    assert cause(AHEAD[:24], x=7.5, **{"catch_from_s": 4.0, **changes}).startswith(words)


def test_a_turtle_that_stands_where_a_withdrawn_target_was_is_told() -> None:
    gone = Track("gone", ((0.0, 7.0, 5.544445, 0.0),), 1.0)
    words = "The turtle stood where gone had been"
    assert words in cause(AHEAD[:24], x=1.0, tracks=(gone,), withdrawn=("gone",))
    assert words not in cause(AHEAD[:24], x=1.0, tracks=(gone,))


@pytest.mark.parametrize(
    ("made", "found"),
    [
        ("min(self.poses, key={})", False),
        ("self.listen({})", True),
        ("self.others = list(filter({}, self.poses))", False),
        ("if name == self.wanted:\n                self.listen({})\n                break", False),
        ("if name == self.wanted:\n                self.listen({})", True),
        ("self.listen({})\n            return", False),
        ("def near(pose):\n                return name\n            near(self.pose)", False),
        ("def near(pose):\n                return name\n            self.listen(near)", True),
    ],
)
def test_a_key_in_a_loop_is_called_before_the_iteration_ends(made: str, *, found: bool) -> None:
    line = f"for name in self.names:\n            {made.format('lambda pose: name')}"
    code = CATCHER.replace("        self.timer", f"        {line}\n        self.timer")
    assert (loop_variable(evidence(recording([]), submission({NODE_FILE: code}))) is not None) == found


@pytest.mark.parametrize(
    ("trial", "tracks", "told"), [("game", (), True), ("game", (1,), False), ("catcher", (), False)]
)
def test_a_game_without_targets_is_the_spawners(trial: str, tracks: tuple[int, ...], *, told: bool) -> None:
    package = open_submission(ROOT / "solutions/13-catch-them-all")
    far = [Track("far", ((0.0, 9.0, 5.5, 0.0),), None) for _ in tracks]
    runs = {trial: Run(recording=recording([], tracks=tuple(far)))}
    given = Evidence(find_exercise("13-catch-them-all"), package, runs=runs).from_trial(trial)
    words = "The spawner created no target in this trial. A request is lost if it is sent before /spawn exists."
    assert (words in why_not_caught(given, far).text) == told


@pytest.mark.parametrize(("topic", "told"), [("/target1/cmd_vel", True), ("/turtle1/cmd_vel", False)])
def test_commands_on_another_topic_are_told(topic: str, *, told: bool) -> None:
    end = Endpoint("publisher", "/draw_circle", topic, "geometry_msgs/msg/Twist")
    graphs = (replace(graph(), endpoints=(end,)),)
    words = "The node publishes on /target1/cmd_vel, but turtle1 listens to /turtle1/cmd_vel."
    assert (words in cause([], graphs=graphs)) == told


@pytest.mark.parametrize(
    ("sends", "told"),
    [("print(msg)", True), ("send = self.publisher.publish\n        send(msg)", False)],
)
def test_another_name_for_publish_counts_as_a_call(sends: str, *, told: bool) -> None:
    code = submission({NODE_FILE: CATCHER.replace("self.publisher.publish(msg)", sends)})
    text = why_not_caught(evidence(recording([]), code), []).text
    assert (text == "publish is never called.") == told


WAITS = "while self.pose is None: pass"
PUBLISHES = "while not self.future.done(): self.publisher.publish(msg)"


@pytest.mark.parametrize(
    ("loop", "commands", "told"),
    [(WAITS, AHEAD[:14], True), (WAITS, [], True), (WAITS, AHEAD, False), (PUBLISHES, AHEAD, True)],
)
def test_a_node_that_sends_until_the_end_is_not_blocked(loop: str, commands: list[Timed], *, told: bool) -> None:
    code = submission({NODE_FILE: CATCHER.replace("        msg = Twist()", f"        msg = Twist()\n        {loop}")})
    far = Track("far", ((0.0, 9.0, 5.544445, 0.0),), None)
    found = why_not_caught(evidence(recording(commands, tracks=(far,)), code), [far])
    assert (found.diagnosis in ("loops-in-callback", "waits-in-callback")) == told
