"""The sentences about interface types, each with an error that is nearly the same."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import DRIVER, reported

TYPE = "AttributeError: {} has no attribute '{}'"
SERVICE = "RuntimeError: The service type provided is not valid (<class 'turtlesim.{}'>)"


@pytest.mark.parametrize(
    ("line", "error", "near", "words"),
    [
        (
            "self.create_publisher('Twist', '/turtle1/cmd_vel', 10)",
            TYPE.format("'str' object", "_TYPE_SUPPORT"),
            TYPE.format("'str' object", "linear"),
            "A string was passed instead of the type. The type comes before the name.",
        ),
        (
            "self.create_client(RotateAbsolute, '/turtle1/rotate_absolute')",
            SERVICE.format("action._rotate_absolute.Metaclass_RotateAbsolute"),
            SERVICE.format("msg._pose.Metaclass_Pose"),
            "This is the type of an action. create_client is for services. For an action, use ActionClient.",
        ),
        (
            "print(future.name)",
            TYPE.format("'Future' object", "name"),
            TYPE.format("'Spawn_Response' object", "name"),
            "This is a future. Its method result() returns what has arrived, such as a response. Look for name there.",
        ),
    ],
)
def test_a_wrong_use_of_an_interface_has_its_own_sentence(line: str, error: str, near: str, words: str) -> None:
    source = DRIVER.format(line=line)
    assert reported(source, error).cause == words
    assert reported(source, near).cause != words
