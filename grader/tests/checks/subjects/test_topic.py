"""The topic: publishers, subscriptions, and the messages that arrived."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.topic import ONLY_TYPE, SUBSCRIBES
from grader.tests.checks.made import DURATION_S, TOPIC, TWIST, evidence, found, node, recording
from grader.tests.checks.node_topics import COLOR, POSE, TEXT, observed, publishes, reported
from grader.tests.checks.shapes import TRACEBACK, crashed
from grader.trial.recording import Message, Output, ProcessEnd, Recording

CRASHED = crashed(3.0)
ENDED = ProcessEnd(by="itself", exit_code=0, t_s=3.0, stop_s=None)


@pytest.mark.parametrize(
    ("topic", "type_", "t_s", "status"),
    [
        ("/chatter", TEXT, 3.0, Status.PASSED),
        ("/chatter", COLOR, 3.0, Status.FAILED),
        ("/other", TEXT, 3.0, Status.FAILED),
        ("/chatter", TEXT, DURATION_S, Status.FAILED),
    ],
)
def test_on_any_topic_a_message_of_the_type_before_ctrl_c_is_enough(
    topic: str, type_: str, t_s: float, status: Status
) -> None:
    trial = recording([], messages=(Message(topic, type_, b"", t_s, t_s),))
    assert publishes(trial, topic="/chatter", type_=TEXT).status is status


def test_on_the_turtles_topic_what_the_simulator_saw_counts() -> None:
    forged = (Message(TOPIC, TWIST, b"", 3.0, 3.0),)
    assert publishes(recording([], messages=forged)).status is Status.FAILED
    assert publishes(recording([(3.0, 2.0, 1.0)], messages=())).status is Status.PASSED
    other = (Message(TOPIC, TEXT, b"", 3.0, 3.0),)
    assert publishes(recording([], messages=other), type_=TEXT).status is Status.PASSED
    assert publishes(recording([], messages=forged), topic="/chatter", type_=TWIST).status is Status.FAILED


def test_of_several_topics_those_of_the_type_and_the_nearest_are_named() -> None:
    both = observed(("publisher", "/turtle1/cmd_vol", TEXT), ("publisher", "/quaff", TWIST))
    assert publishes(both).observed == "The node publishes on /quaff, but turtle1 does not subscribe to it."
    near = observed(("publisher", "/a", TWIST), ("publisher", "/turtle1/cmd_val", TWIST))
    assert publishes(near).observed == "The node publishes on /turtle1/cmd_val, but turtle1 does not subscribe to it."
    far = observed(("publisher", "/quaff", TWIST), ("publisher", "/a", TWIST))
    assert publishes(far).observed == "The node publishes on /a and /quaff, but turtle1 does not subscribe to them."
    other = observed(("publisher", "/a", TEXT), ("publisher", "/quaff", COLOR))
    assert publishes(other).observed == "The node publishes on /a and /quaff, but turtle1 does not subscribe to them."


@pytest.mark.parametrize(("type_", "diagnosis"), [(TEXT, "crash"), (TWIST, "wrong-topic")])
def test_a_crash_explains_a_missing_publisher_unless_another_has_the_type(type_: str, diagnosis: str) -> None:
    trial = observed(("publisher", "/speed", type_), end=CRASHED, stderr=Output(TRACEBACK))
    assert reported(publishes(trial))[0] == diagnosis


@pytest.mark.parametrize(
    ("first", "line"),
    [
        ('self.create_publisher(String, "chatter", 10)', ":10"),
        ('self.create_publisher(String, "/turtle1/cmd_vel/", 10)', ":9"),
        ("self.create_publisher(String, NAME, 10)", ":10"),
        ("self.create_publisher(String, 3, 10)", ":10"),
    ],
)
def test_the_line_is_that_of_the_publisher_of_this_topic(first: str, line: str) -> None:
    trial = observed(("publisher", TOPIC, TEXT))
    finding = publishes(trial, ("        self.publisher =", f"        self.other = {first}\n        self.publisher ="))
    assert reported(finding) == ("wrong-type", line)


def test_several_wrong_types_are_in_the_plural() -> None:
    trial = observed(("publisher", TOPIC, TEXT), ("publisher", TOPIC, COLOR))
    both = f"the types {TEXT} and {COLOR}"
    assert f"with {both}, which the turtle does not understand." in publishes(trial).observed
    assert found(ONLY_TYPE, evidence(trial), topic=TOPIC, type=TWIST).observed == f"{TOPIC} has {both}."


def test_a_publisher_whose_topic_is_not_known_is_better_than_none() -> None:
    trial = observed(("publisher", TOPIC, TEXT))
    assert reported(publishes(trial, ('"/turtle1/cmd_vel"', "NAME"))) == ("wrong-type", ":9")
    assert reported(publishes(trial, ("create_publisher", "make"))) == ("wrong-type", "")


@pytest.mark.parametrize(
    ("end", "stderr", "changes", "diagnosis", "line", "words"),
    [
        (CRASHED, TRACEBACK, (), "crash", ":14", "The node crashed after 3.0 s: ZeroDivisionError"),
        (ENDED, "", (), "no-publisher", ":9", "The node exited on its own after 3.0 s."),
        (None, "", (), "no-publisher", ":9", "The node has no publisher."),
        (None, "", (("create_publisher", "make"),), "no-publisher", "", "The node has no publisher."),
        (None, "", (("create_timer(0.5", "create_timer(500"),), "timer-milliseconds", ":10", "The node has no"),
        (
            None,
            "",
            (("create_publisher", "make"), ("create_timer(0.5", "create_timer(500")),
            "no-publisher",
            "",
            "The node has no publisher.",
        ),
    ],
)
def test_a_node_without_a_publisher_is_explained(
    end: ProcessEnd | None, stderr: str, changes: tuple[tuple[str, str], ...], diagnosis: str, line: str, words: str
) -> None:
    more = {"end": end} if end is not None else {}
    finding = publishes(observed(stderr=Output(stderr), **more), *changes)
    assert reported(finding) == (diagnosis, line)
    assert finding.observed.startswith(words)
    if diagnosis == "no-publisher":
        assert finding.cause == ("create_publisher is never called." if changes else "")


@pytest.mark.parametrize(
    ("end", "stderr", "changes", "diagnosis", "line"),
    [
        (CRASHED, TRACEBACK, (), "crash", ":14"),
        (ENDED, "", (), "ended-early", ":21"),
        (ENDED, "", (("rclpy.spin(", "print("),), "no-spin", ":20"),
        (None, "", (("self.publisher.publish(msg)", "pass"),), "no-publish", ""),
        (None, "incompatible QoS", (), "qos-mismatch", ":9"),
        (None, "", (("rclpy.spin(", "print("),), "no-spin", ""),
        (None, "", (), "never-publishes", ":16"),
    ],
)
def test_a_silent_publisher_is_explained(
    end: ProcessEnd | None, stderr: str, changes: tuple[tuple[str, str], ...], diagnosis: str, line: str
) -> None:
    more = {"end": end} if end is not None else {}
    finding = publishes(observed(("publisher", TOPIC, TWIST), stderr=Output(stderr), **more), *changes)
    assert reported(finding) == (diagnosis, line)
    if end is None:
        assert finding.observed == f"There is a publisher on {TOPIC}, but no message arrived after the start."
    elif diagnosis != "crash":
        assert finding.observed.endswith("no message arrived after the start. The node exited on its own after 3.0 s.")


def test_a_second_type_is_reported_whoever_shows_it() -> None:
    by_graph = observed(("publisher", TOPIC, TWIST), ("publisher", TOPIC, TEXT), ("publisher", "/other", COLOR))
    messages = tuple(Message(topic, type_, b"", 3.0, 3.0) for topic, type_ in ((TOPIC, TEXT), ("/other", COLOR)))
    by_message = replace(observed(("publisher", TOPIC, TWIST)), messages=messages)
    for trial in (by_graph, by_message):
        finding = found(ONLY_TYPE, evidence(trial), topic=TOPIC, type=TWIST)
        assert reported(finding) == ("second-type", ":9")
        assert finding.observed == f"{TOPIC} also has the type {TEXT}."
    one = observed(("publisher", TOPIC, TWIST), ("publisher", "/other", COLOR))
    assert found(ONLY_TYPE, evidence(one), topic=TOPIC, type=TWIST).status is Status.PASSED


@pytest.mark.parametrize(
    ("trial", "diagnosis", "line", "words"),
    [
        (observed(("subscription", POSE, TEXT)), None, None, "The node subscribes"),
        (observed(("subscription", "/a", TEXT), ("subscription", POSE, TEXT)), None, None, "The node subscribes"),
        (
            observed(("subscription", POSE, COLOR)),
            "wrong-type",
            ":10",
            f"The node subscribes to {POSE} with the type {COLOR},",
        ),
        (observed(("subscription", "/a", TEXT)), "wrong-topic", ":10", "The node subscribes to /a, but not to"),
        (
            observed(("subscription", "/a", COLOR), ("subscription", "/b", TEXT)),
            "wrong-topic",
            ":10",
            "The node subscribes to /b, but not to",
        ),
        (observed(), "no-subscription", ":10", "The node has no subscription."),
        (observed(end=CRASHED, stderr=Output(TRACEBACK)), "crash", ":14", "The node crashed after 3.0 s:"),
    ],
)
def test_a_subscription_is_looked_for(trial: Recording, diagnosis: str | None, line: str | None, words: str) -> None:
    package = node(
        ("self.timer = self.create_timer(0.5, self.send)", "self.create_subscription(Pose, NAME, self.send, 10)")
    )
    finding = found(SUBSCRIBES, evidence(trial, package), topic=POSE, type=TEXT)
    assert reported(finding) == (diagnosis, line)
    assert finding.observed.startswith(words)
    if diagnosis == "no-subscription":
        assert finding.cause == ""
        nowhere = found(SUBSCRIBES, evidence(trial), topic=POSE, type=TEXT)
        assert (reported(nowhere), nowhere.cause) == ((diagnosis, ""), "create_subscription is never called.")


@pytest.mark.parametrize(("line", "told"), [("wait_for_message(Pose, self, NAME)", True), ("wait(Pose, NAME)", False)])
def test_a_wait_for_a_message_is_not_a_subscription(line: str, *, told: bool) -> None:
    package = node(("self.timer = self.create_timer(0.5, self.send)", line))
    finding = found(SUBSCRIBES, evidence(observed(), package), topic=POSE, type=TEXT)
    assert ("wait_for_message listens only while it waits, and it blocks the node." in finding.cause) == told
    assert ("create_subscription is never called." in finding.cause) != told


@pytest.mark.parametrize(
    ("line", "diagnosis"),
    [("self.on == True", "equals"), ("self.on = True", "never-publishes"), ("self.off == 1", "never-publishes")],
)
def test_a_condition_that_is_only_compared_keeps_a_publisher_silent(line: str, diagnosis: str) -> None:
    changes = (
        ("self.timer =", f"{line}\n        self.timer ="),
        ("        self.publisher.publish(msg)", "        if self.on:\n            self.publisher.publish(msg)"),
    )
    finding = publishes(observed(("publisher", TOPIC, TWIST)), *changes)
    assert reported(finding) == (diagnosis, ":10" if diagnosis == "equals" else ":18")


def test_the_sentences_about_types_are_told_only_for_a_wrong_type() -> None:
    wrong, silent = (publishes(observed(("publisher", TOPIC, type_))) for type_ in (TEXT, TWIST))
    words = "which the turtle does not understand."
    assert wrong.observed == f"The node publishes on {TOPIC} with the type {TEXT}, {words}"
    assert wrong.cause == "The message type is the first argument of create_publisher."
    assert "with the type" not in silent.observed
    assert "The message type is the first argument" not in silent.cause
    listening, other = (publishes(observed(("subscription", topic, TWIST))) for topic in (TOPIC, "/other"))
    assert listening.cause == "A subscription only receives messages. Use create_publisher to send messages."
    assert "A subscription only receives messages" not in other.cause
    two = observed(("publisher", TOPIC, TWIST), ("publisher", TOPIC, TEXT))
    second, one = (
        found(ONLY_TYPE, evidence(each), topic=TOPIC, type=TWIST)
        for each in (two, observed(("publisher", TOPIC, TWIST)))
    )
    assert second.cause.startswith("All publishers of a topic must use the same type.")
    assert (one.status, one.cause) == (Status.PASSED, "")
    assert one.observed == f"Only {TWIST} messages are published on {TOPIC}."


@pytest.mark.parametrize(("types", "two"), [((TWIST, TEXT), True), ((TEXT,), False)])
def test_a_single_type_is_no_second_type(types: tuple[str, ...], *, two: bool) -> None:
    trial = observed(*(("publisher", TOPIC, each) for each in types))
    finding = found(ONLY_TYPE, evidence(trial), topic=TOPIC, type=TWIST)
    assert (finding.observed == f"{TOPIC} also has the type {TEXT}.") == two
    assert (finding.observed == f"{TOPIC} has the type {TEXT}.") != two
    assert finding.diagnosis == ("second-type" if two else "wrong-type")
