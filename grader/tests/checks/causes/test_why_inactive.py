"""A lifecycle node that nothing activates is silent."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_inactive import never_activated
from grader.tests.checks.crashes import LOOK, line_with
from grader.tests.checks.made import NODE_FILE, evidence, recording, submission

SOURCE = """\
class Driver({base}):
    def __init__(self):
        super().__init__("driver")
        self.publisher = self.{maker}(Twist, "/turtle1/cmd_vel", 10)

    def {method}(self, state):
        self.create_timer(0.5, self.send)

node = Driver()
{last}
rclpy.spin(node)
"""
MAKER = "create_lifecycle_publisher"


@pytest.mark.parametrize(
    ("base", "maker", "method", "last", "more"),
    [
        ("LifecycleNode", MAKER, "on_activate", "pass", " So on_activate is never called."),
        ("rclpy.lifecycle.LifecycleNode", MAKER, "on_configure", "pass", " So on_configure is never called."),
        ("LifecycleNode", "create_publisher", "on_activate", "pass", " So on_activate is never called."),
        ("LifecycleNode", MAKER, "start", "pass", ""),
        ("LifecycleNode", "create_publisher", "start", "pass", None),
        ("LifecycleNode", MAKER, "on_activate", "node.trigger_activate()", None),
        ("Node", MAKER, "on_activate", "pass", None),
    ],
)
def test_a_node_that_waits_for_its_activation_is_found(
    base: str, maker: str, method: str, last: str, more: str | None
) -> None:
    source = SOURCE.format(base=base, maker=maker, method=method, last=last)
    look = source.replace("(self, state):", f"(self, state):  {LOOK}") if more else f"class  {LOOK}"
    cause = never_activated(evidence(recording([]), submission({NODE_FILE: source})))
    words = "A lifecycle node waits until it is activated, and nothing activates this node."
    assert (cause and cause.text) == (None if more is None else words + more)
    assert cause is None or (cause.where and cause.where.line) == line_with(LOOK, look)
