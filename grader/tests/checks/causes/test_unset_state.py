"""States that a node compares and never sets, and coroutines that never get a response, next to correct programs."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_blocked import why_blocked
from grader.tests.checks.crashes import LOOK, line_with
from grader.tests.checks.made import NODE_FILE, evidence, submission

NODE = """\
class Driver(Node):
    {of_class}

    def __init__(self):
        super().__init__("driver")
        self.pen = self.create_client(SetPen, "/turtle1/set_pen"{group})
        self.create_timer(0.1, self.step)
        {init}

    {step}


rclpy.spin(Driver())
"""
ASK = "\n\n    async def ask(self):\n        await self.pen.call_async(1)"


def blocked(step: str, init: str = "pass", of_class: str = "", group: str = "") -> str:
    source = NODE.format(of_class=of_class, init=init, step=step, group=group)
    cause = why_blocked(evidence(package=submission({NODE_FILE: source})))
    if cause is not None:
        assert cause.where is not None
        assert cause.where.line == line_with(LOOK, source)
    return "" if cause is None else cause.text


@pytest.mark.parametrize(
    ("init", "of_class", "test", "told"),
    [
        ("self.state = 'driving'", "", "self.state == 'drive':  # look", True),
        ("self.state, self.ticks = 'driving', 0", "", "self.state == 'drive':  # look", True),
        ("self.state = 'turn' if self.pen else 'driving'", "", "self.state == 'drive':  # look", True),
        ("self.state = 'drive'", "", "self.state == 'drive':", False),
        ("self.state = 'turn' if self.pen else 'drive'", "", "self.state == 'drive':", False),
        ("self.state = 'turn'", "state = 'drive'", "self.state == 'drive':", False),
        ("self.state = self.first()", "", "self.state == 'drive':", False),
        ("self.state, self.ticks = self.first()", "", "self.state == 'drive':", False),
        ("self.state = 'turn'; driver.state = 'drive'", "", "self.state == 'drive':", False),
        ("self.state = 'turn'; setattr(self, 'state', 'drive')", "", "self.state == 'drive':", False),
        ("self.state = 'turn'", "", "self.state != 'drive':", False),
        ("self.state = 'turn'", "", "self.name == 'drive':", False),
    ],
)
def test_a_state_that_nothing_sets_is_told(init: str, of_class: str, test: str, *, told: bool) -> None:
    words = 'Nothing sets self.state to "drive", so this condition is never true.' if told else ""
    assert blocked(f"def step(self):\n        if {test}\n            self.stop()", init, of_class) == words


@pytest.mark.parametrize(
    ("step", "group", "words"),
    [
        (
            "async def step(self):\n        await self.pen.call_async(1)  # look",
            "",
            "step is in the same callback group",
        ),
        (
            "async def step(self):\n        coming = self.pen.call_async(1)\n        await coming  # look",
            "",
            "step is in the same callback group",
        ),
        (
            f"async def step(self):\n        await self.ask(){ASK}  # look",
            "",
            "ask is in the same callback group",
        ),
        ("async def step(self):\n        await self.pen.call_async(1)", ", callback_group=other", ""),
        ("async def step(self):\n        await self.beat", "", ""),
        (
            f"def step(self):\n        self.executor.create_task(self.ask()){ASK}",
            "",
            "",
        ),
        (
            f"def step(self):\n        self.ask()  # look{ASK}",
            "",
            "ask is a coroutine (async def), so a call without await only creates it",
        ),
    ],
)
def test_a_coroutine_that_gets_no_response_is_told(step: str, group: str, words: str) -> None:
    told = blocked(step, group=group)
    assert told.startswith(words)
    assert bool(told) == bool(words)
