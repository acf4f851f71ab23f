"""A finding about a log line is shown at the call that can have written the line."""

from __future__ import annotations

import pytest

from grader.tests.checks.made import NODE_FILE
from grader.tests.checks.node_log import LOGS, in_format, lines


@pytest.mark.parametrize(
    ("message", "line"),
    [
        ("str(self.count)", "turtle 3"),
        ('"turtle " + str(self.count)', "turtle 3"),
        ('f"turtle {self.count}"', "turtle 3"),
        ('"turtle %d" % self.count', "turtle 3"),
        ('"turtle {} of 9".format(self.count)', "turtle 3 of 9"),
        ('"turtle" + " 3"', "turtle 3"),
    ],
)
def test_the_place_is_the_call_that_can_have_written_the_line(message: str, line: str) -> None:
    wrong = ('"I have started"', 'f"{self.count} turtles"', '"a turtle %d" % 3', '"turtle {}s".format(3)')
    for first in wrong:
        node = LOGS.replace("super()", f"self.get_logger().info({first})\n        super()", 1)
        start = node[: node.index(first)].count("\n") + 1
        node = node.replace("def send(self):", f"def send(self):\n        self.get_logger().info({message})")
        here = node[: node.index(message)].count("\n") + 1
        assert str(in_format(lines(line), node=node).where) == f"{NODE_FILE}:{here}"
        unknown = here if message.startswith("str(") else start
        assert str(in_format(lines("I ended"), node=node).where) == f"{NODE_FILE}:{unknown}"
