"""The reasons why no call arrives at a service."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_unasked import why_unasked
from grader.tests.checks.made import NODE, NODE_FILE, evidence, recording, submission

CLIENT = NODE.replace(
    "        self.timer", '        self.client = self.create_client(SetPen, "{name}")\n        {line}self.timer'
)
CALLS = "self.client.call_async(SetPen.Request())\n        "
PEN = "/turtle1/set_pen"


@pytest.mark.parametrize(
    ("code", "words"),
    [
        (NODE, "The node has no client for this service. See create_client."),
        (
            CLIENT.format(name=PEN, line=""),
            "Creating a client sends nothing. The client's method call_async sends a request.",
        ),
        (CLIENT.format(name=PEN, line=CALLS), ""),
        (
            CLIENT.format(name="/set_pen", line=CALLS),
            "The client uses the name /set_pen. The name of the service is /turtle1/set_pen.",
        ),
        (CLIENT.format(name="/stop", line=CALLS), ""),
    ],
)
def test_what_the_source_lacks_is_told(code: str, words: str) -> None:
    assert why_unasked(evidence(recording([]), submission({NODE_FILE: code})), PEN).text == words
