"""The reasons why no call arrives at a service."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_unasked import why_unasked
from grader.tests.checks.made import NODE, NODE_FILE, evidence, recording, submission

CLIENT = NODE.replace(
    "        self.timer", '        self.client = self.create_client(SetPen, "{name}")\n        {line}self.timer'
)
IN_SEND = "def send(self):\n        self.client.call_async(SetPen.Request())"
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
        (
            CLIENT.format(name=PEN, line=CALLS),
            "__init__ sends a request. The request is lost if the service does not exist yet.",
        ),
        (CLIENT.format(name=PEN, line=f"self.client.wait_for_service()\n        {CALLS}"), ""),
        (CLIENT.format(name=PEN, line="").replace("def send(self):", IN_SEND), ""),
        (
            CLIENT.format(name="/set_pen", line=CALLS),
            "The client uses the name /set_pen. The name of the service is /turtle1/set_pen.",
        ),
        (
            CLIENT.format(name="/stop", line="").replace(
                "def send(self):", f"def send(self):\n        {CALLS.strip()}"
            ),
            "",
        ),
    ],
)
def test_what_the_source_lacks_is_told(code: str, words: str) -> None:
    assert why_unasked(evidence(recording([]), submission({NODE_FILE: code})), PEN).text == words


NOT_READY = "__init__ sends a request. The request is lost if the service does not exist yet."
HELPER = CLIENT.format(name=PEN, line="self.ask()\n        ")
ASKS = "    def ask(self):\n        {}self.client.call_async(SetPen.Request())\n\n    def send(self):"
WAIT = "while not self.client.wait_for_service(1.0): pass"
LATER = "def later(): self.client.call_async(SetPen.Request())\n        "


def helper(line: str) -> str:
    return HELPER.replace("    def send(self):", ASKS.format(line), 1)


@pytest.mark.parametrize(
    ("code", "words"),
    [
        (helper(""), NOT_READY),
        (helper(f"{WAIT}\n        "), ""),
        (helper("self.wait()\n        ") + f"\n\nclass Base:\n    def wait(self):\n        {WAIT}\n", ""),
        (helper("wait(self.client)\n        ") + "\n\ndef wait(it):\n    it.wait_for_service()\n", ""),
        (helper("").replace("self.ask()", "self.other.ask()"), ""),
        (CLIENT.format(name=PEN, line=LATER), ""),
    ],
)
def test_a_request_that_a_method_sends_for_init_is_too_early_unless_something_waits(code: str, words: str) -> None:
    assert why_unasked(evidence(recording([]), submission({NODE_FILE: code})), PEN).text == words


READY = CLIENT.replace("self.timer", 'self.spawn = self.create_client(Spawn, "{spawn}")\n        self.timer', 1)


@pytest.mark.parametrize(
    ("spawn", "asks", "found"),
    [
        ("/turtle1/spawn", "self.spawn.service_is_ready()", True),
        ("/turtle1/spawn", "self.client.service_is_ready()", False),
        ("/spawn", "self.spawn.service_is_ready()", False),
    ],
)
def test_another_service_that_does_not_exist_keeps_the_node_from_calling(spawn: str, asks: str, *, found: bool) -> None:
    code = READY.format(name=PEN, spawn=spawn, line=f"if {asks}:\n            {CALLS}")
    cause = why_unasked(evidence(recording([]), submission({NODE_FILE: code})), PEN)
    assert (cause.diagnosis == "service-not-there") == found
    words = "The node waits for the service /turtle1/spawn, which does not exist. A similar service exists: /spawn."
    assert (words in cause.text) == found
