"""A conductor that is a program of a test."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.common.interpreter import Start

if TYPE_CHECKING:
    import pytest

READY = """read plan; echo '{"ready": true}'; read order"""
"""A program for sh that is ready for the node, and waits for the order to start it."""


def replace_conductor(monkeypatch: pytest.MonkeyPatch, program: str) -> None:
    """Run this program for sh as the conductor of trials without a sandbox."""
    start = Start(["sh", "-c", program], {"PATH": "/usr/bin:/bin"})
    monkeypatch.setattr("grader.trial.conductor_process.interpreter", lambda *_, **__: start)
