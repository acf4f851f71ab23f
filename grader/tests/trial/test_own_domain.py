"""A trial without a sandbox has a ROS domain for itself."""

from __future__ import annotations

import tempfile
from contextlib import ExitStack
from typing import TYPE_CHECKING

import pytest

from grader.trial import own_domain

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(autouse=True)
def _no_other_locks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))


def test_a_domain_with_nodes_is_left_out(monkeypatch: pytest.MonkeyPatch) -> None:
    """The user may have started a turtlesim, which the node of the trial would drive."""
    monkeypatch.setattr(own_domain, "participant_ports", lambda domain: {7410} if domain in (1, 2, 4) else set())
    with ExitStack() as stack:
        assert [own_domain.own_domain(stack) for _ in range(2)] == [3, 5]
