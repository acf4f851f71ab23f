"""A failed transition of a lifecycle node is explained, although rclpy hides the exception."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import reported, to_look_at

ERROR = "RCLError: Failed to trigger lifecycle state machine transition: Transition is not registered."
SOURCE = """\
{imports}from rclpy.lifecycle import LifecycleNode

class Driver(LifecycleNode):
    def on_configure(self, state):
        self.p = self.create_lifecycle_publisher(Twist, "/a", 10){look}

Driver().trigger_activate()  # crashed
"""


@pytest.mark.parametrize("imports", ["", "from geometry_msgs.msg import Twist\n"])
def test_a_class_without_an_import_is_found_in_a_callback(imports: str) -> None:
    source = SOURCE.format(imports=imports, look="" if imports else "  # look")
    found = reported(source, ERROR)
    assert (found.diagnosis, found.line) == ("crash" if imports else "missing-import", to_look_at(source))
    words = "An earlier transition may have failed." if imports else "the file does not import Twist."
    assert "rclpy hides" in found.cause
    assert words in found.cause


@pytest.mark.parametrize(
    ("error", "found"),
    [
        ("RCLError: Failed to trigger lifecycle state machine transition: unknown", True),
        ("RCLError: Failed to trigger lifecycle state machine: unknown", False),
        ("RCLError: Failed to publish", False),
    ],
)
def test_another_error_is_not_taken_for_a_transition(error: str, *, found: bool) -> None:
    assert ("rclpy hides" in reported(SOURCE.format(imports="", look=""), error).cause) == found
