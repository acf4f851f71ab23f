"""A timer that is cancelled explains why messages stop, if it is the timer that sends them."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_stopped import cancelled
from grader.tests.checks.crashes import LOOK, line_with
from grader.tests.checks.made import NODE_FILE, evidence, recording, submission

NODE = """\
class Driver(Node):
    def __init__(self):
        self.timer = self.create_timer(0.5, self.send)
        self.once = self.create_timer(1.0, self.start)

    def send(self):
        {send}
        self.publisher.publish(msg)

    def start(self):
        {start}

    def close(self):
        self.timer.cancel()


node = Driver()
rclpy.spin(node)
{last}
"""


@pytest.mark.parametrize(
    ("send", "start", "last", "found"),
    [
        ("if self.count > 8: self.timer.cancel()  # look", "pass", "", True),
        ("pass", "self.timer.cancel()  # look", "", True),
        ("pass", "self.once.cancel()", "", False),
        ("self.goal.cancel()", "pass", "", False),
        ("self.stop()\n\n    def stop(self):\n        self.timer.cancel()  # look", "pass", "", True),
        ("pass", "pass", "node.timer.cancel()", False),
        ("pass", "pass", "node.close()", False),
        ("self.timer.cancel()", "self.timer.reset()", "", False),
        ("pass", "pass", "", False),
    ],
)
def test_only_the_timer_that_sends_stops_the_messages(send: str, start: str, last: str, *, found: bool) -> None:
    source = NODE.format(send=send, start=start, last=last)
    where = cancelled(evidence(recording([]), submission({NODE_FILE: source})), "publish")
    assert (where is not None) == found
    assert where is None or where.line == line_with(LOOK, source)


def test_the_timer_counts_if_nothing_calls_the_function() -> None:
    source = NODE.format(send="self.timer.cancel()  # look", start="pass", last="").replace("publish(", "send_to(")
    where = cancelled(evidence(recording([]), submission({NODE_FILE: source})), "publish")
    assert where is not None
