"""A wrong topic name is explained by the names in the source and by the topics of other nodes."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.checks.subjects.topic import PUBLISHES, SUBSCRIBES
from grader.tests.checks.made import TOPIC, TWIST, evidence, found, node, recording
from grader.tests.checks.node_topics import COLOR, POSE, TEXT, observed, publishes, reported
from grader.trial.recording import Endpoint, Graph


@pytest.mark.parametrize(
    ("topic", "diagnosis"),
    [
        ("/cmd_vel", "topic-without-turtle"),
        ("/turtle1/CMD_vel", "topic-capitals"),
        ("/draw_circle/turtle1/cmd_vel", "topic-namespace"),
        ("/robot/turtle1/cmd_vel", "wrong-topic"),
        ("/draw_circle", "wrong-topic"),
        ("/turtle2/cmd_vel", "topic-other-turtle"),
        ("/a_node_of_quite_another_kind/cmd_vel", "wrong-topic"),
        ("/a/turtle2/cmd_vel", "wrong-topic"),
        ("/turtle1/cmd_val", "wrong-topic"),
    ],
)
def test_another_topic_is_explained_by_the_two_names(topic: str, diagnosis: str) -> None:
    finding = publishes(observed(("publisher", topic, TWIST)))
    assert reported(finding) == (diagnosis, ":9")
    assert finding.observed == f"The node publishes on {topic}, but turtle1 does not subscribe to it."


@pytest.mark.parametrize(
    ("name", "added"),
    [
        ("/robot/draw_circle", "The node adds its namespace to the name."),
        ("/robot", "ROS 2 replaces ~ at the beginning of a topic name with the name of the node."),
        ("/robotic/draw_circle", None),
    ],
)
def test_what_ros_adds_to_a_topic_name_is_told_only_of_such_a_node(name: str, added: str | None) -> None:
    ends = (Endpoint("publisher", name, f"/robot{TOPIC}", TWIST),)
    finding = publishes(recording([], graphs=(Graph(0.0, (name,), ends),)))
    assert (finding.diagnosis == "topic-namespace") == (added is not None)
    assert finding.cause.startswith(f"{added} A name that" if added else "The topic name is the second argument")


@pytest.mark.parametrize(
    ("topic", "diagnosis", "line"),
    [
        ("/pose", "topic-without-turtle", ":11"),
        ("/turtle1/Pose", "topic-capitals", ":11"),
        ("/draw_circle/turtle1/pose", "topic-namespace", ":10"),
        ("/turtle2/pose", "topic-other-turtle", ":11"),
        ("/turtle1/position", "wrong-topic", ":11"),
    ],
)
def test_a_wrong_topic_of_a_subscription_is_explained_like_one_of_a_publisher(
    topic: str, diagnosis: str, line: str
) -> None:
    name = "turtle1/pose" if diagnosis == "topic-namespace" else topic
    one = f'self.create_subscription(Pose, "{name}", print, 10)'
    two = f"self.create_subscription(Pose, NAME, print, 10)\n        {one}"
    package = node(("self.timer = self.create_timer(0.5, self.send)", one if diagnosis == "topic-namespace" else two))
    finding = found(SUBSCRIBES, evidence(observed(("subscription", topic, TEXT)), package), topic=POSE, type=TEXT)
    assert reported(finding) == (diagnosis, line)
    if diagnosis == "wrong-topic":
        assert finding.cause.startswith("The topic name is the second argument of create_subscription.")


RENAMED = 'rclpy.init(args=["--ros-args", "-r", "{}:=/{}"])'


@pytest.mark.parametrize(
    ("topic", "rule", "new", "told"),
    [
        (TOPIC, TOPIC, "other", True),
        (TOPIC, "cmd_vel", "other", True),
        (TOPIC, "/chatter", "other", False),
        (TOPIC, "Start it with -r cmd_vel", "other", False),
        (TOPIC, "cmd_vel", "third", False),
        ("/other", TOPIC, "other", False),
    ],
)
def test_a_remapping_rule_is_told(topic: str, rule: str, new: str, *, told: bool) -> None:
    words = "This remapping rule gives the topic another name."
    changes = (("rclpy.init(args=args)", RENAMED.format(rule, new)), (f'"{TOPIC}"', f'"{topic}"'))
    finding = found(
        PUBLISHES, evidence(observed(("publisher", "/other", TWIST)), node(*changes)), topic=TOPIC, type=TWIST
    )
    assert (words in finding.cause, finding.diagnosis) == (told, "wrong-topic")


@pytest.mark.parametrize(("topic", "told"), [("/turtle1/cmd_val", True), ("/odom", False)])
def test_only_similar_names_are_compared_letter_by_letter(topic: str, *, told: bool) -> None:
    finding = publishes(observed(("publisher", topic, TWIST)))
    assert finding.cause.startswith("The topic name is the second argument of create_publisher.")
    assert ("Check the topic name letter by letter." in finding.cause) == told


def test_a_turtle_that_exists_is_not_denied() -> None:
    trial = observed(("publisher", "/turtle2/cmd_vel", TWIST))
    second = Endpoint("subscription", "/turtlesim", "/turtle2/cmd_vel", TWIST)
    both = replace(trial, graphs=(replace(trial.graphs[0], endpoints=(*trial.graphs[0].endpoints, second)),))
    assert publishes(trial).cause == "There is no turtle with that name."
    assert reported(publishes(both)) == ("wrong-topic", ":9")
    assert publishes(both).cause.endswith("This topic belongs to another turtle.")
    only = observed(("publisher", POSE, TWIST))
    own = Endpoint("publisher", "/turtlesim", POSE, "turtlesim/msg/Pose")
    pose = replace(only, graphs=(replace(only.graphs[0], endpoints=(*only.graphs[0].endpoints, own)),))
    assert publishes(pose).cause.endswith("turtlesim uses this topic for something else.")
    assert "This topic belongs to another turtle." not in publishes(pose).cause


@pytest.mark.parametrize(("topic", "told"), [("/turtle1/color_sensor", True), ("/turtle1/colour", False)])
def test_a_topic_of_turtlesim_for_something_else_is_told(topic: str, *, told: bool) -> None:
    trial = observed(("publisher", topic, TWIST))
    sensor = Endpoint("publisher", "/turtlesim", "/turtle1/color_sensor", COLOR)
    graphs = (replace(trial.graphs[0], endpoints=(*trial.graphs[0].endpoints, sensor)),)
    finding = publishes(replace(trial, graphs=graphs))
    assert ("turtlesim uses this topic for something else." in finding.cause, finding.diagnosis) == (
        told,
        "wrong-topic",
    )
