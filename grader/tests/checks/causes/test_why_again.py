"""A node that calls a service again and again for the same target."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_again import why_again
from grader.tests.checks.made import NODE, NODE_FILE, evidence, recording, submission

CALLS = NODE.replace("        self.timer", "        self.client.call_async(Kill.Request())\n        self.timer", 1)
WAITS = CALLS.replace(
    "        self.client",
    '        self.asked = "near"\n        if self.asked is not None:\n            pass\n        self.client',
    1,
).replace("    def send(", "    def caught(self, future):\n        self.asked = None  # look\n\n    def send(", 1)


@pytest.mark.parametrize(
    ("source", "found"),
    [
        (WAITS, True),
        (WAITS.replace("self.asked = None", "self.asked = False"), True),
        (WAITS.replace("if self.asked", "if self.pose"), False),
        (WAITS.replace("self.asked = None", "self.asked = future"), False),
        (CALLS, False),
    ],
)
def test_a_node_that_waits_for_the_response_is_not_told_to_wait(source: str, *, found: bool) -> None:
    cause = why_again(evidence(recording([]), submission({NODE_FILE: source})))
    assert ("When the response has arrived, the node must also forget the target" in cause.text) == found
    assert ("Store in an attribute whether the node is waiting" in cause.text) != found
    look = next((at for at, line in enumerate(source.splitlines(), 1) if "# look" in line), None)
    assert (cause.where is not None and cause.where.line == look) == found
