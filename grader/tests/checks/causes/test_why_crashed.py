"""The causes of exceptions that rclpy raises."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import DRIVER, reported, to_look_at

ERROR = "InvalidTopicNameException: Invalid topic name: topic name must not contain characters"


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ('self.create_publisher(Twist, "/turtle1/cmd vel", 10)', 'The name here is "/turtle1/cmd vel", with a space.'),
        ('self.create_subscription(Pose, topic="a-b", callback=x)', 'The name here is "a-b".'),
        ("self.create_publisher(Twist, TOPIC, 10)", "underscores and slashes."),
        ('print("no topic")', "underscores and slashes."),
    ],
)
def test_an_invalid_topic_is_shown(line: str, words: str) -> None:
    found = reported(DRIVER.format(line=line), ERROR)
    assert found.diagnosis == "topic-name-invalid"
    assert found.cause.endswith(words)


def test_an_invalid_topic_is_shown_at_its_own_line() -> None:
    call = "self.create_publisher(  # crashed\n            Twist, 'a b', 10)  # look\n        x = 1"
    source = DRIVER.format(line=call).replace("x = 1  # crashed", "x = 1")
    assert reported(source, ERROR).line == to_look_at(source)
