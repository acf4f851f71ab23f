"""The simulator of a notebook, with another program in place of turtlesim."""

from __future__ import annotations

import os
from types import SimpleNamespace
from typing import TYPE_CHECKING

import pytest

from grader.common.interpreter import interpreter
from grader.errors import MachineError, UsageError
from grader.notebook import simulator
from grader.notebook.cells import Cells

if TYPE_CHECKING:
    from collections.abc import Mapping

WARNS = """
import struct, sys
sys.stderr.write("Oh no! I hit the wall!\\n" * 20_000)
sys.stderr.flush()
sys.stdout.buffer.write(struct.pack(">I", 7) + b"picture")
sys.stdout.buffer.flush()
sys.stdin.read()
"""


@pytest.fixture(autouse=True)
def _in_no_step(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NBGRADER_EXECUTION", raising=False)
    monkeypatch.setattr("IPython.display.Image", bytes)
    monkeypatch.setattr("IPython.display.display", lambda *_, **__: SimpleNamespace(update=lambda _: None))


def instead(monkeypatch: pytest.MonkeyPatch, code: str) -> None:
    def start(*_: str, env: Mapping[str, str], searches: bool) -> object:
        return interpreter("-c", code, env=env, searches=searches)

    monkeypatch.setattr(simulator, "environment", lambda: dict(os.environ))
    monkeypatch.setattr(simulator, "interpreter", start)


def test_a_turtle_at_a_wall_may_log_as_much_as_it_likes(monkeypatch: pytest.MonkeyPatch) -> None:
    instead(monkeypatch, WARNS)
    with simulator.Simulator() as sim:
        assert sim.picture() == b"picture"


def test_the_reason_why_turtlesim_did_not_start_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    instead(monkeypatch, "import sys; sys.exit('no display')")
    with pytest.raises(MachineError, match="turtlesim did not start: no display"), simulator.Simulator():
        pass


def test_a_quote_that_is_not_closed_is_named() -> None:
    with pytest.raises(UsageError, match="a quote that is not closed"):
        Cells().ros2('topic pub /chatter std_msgs/msg/String "{data: hi}')
