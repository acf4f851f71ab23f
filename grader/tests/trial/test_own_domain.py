"""A trial without a sandbox has a ROS domain for itself."""

from __future__ import annotations

import tempfile
from contextlib import ExitStack
from typing import TYPE_CHECKING

import pytest

from grader.errors import MachineError
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


def test_each_domain_is_given_once_and_then_again_when_it_is_free(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(own_domain, "participant_ports", lambda _: set())
    usable = [*range(1, 102), *range(215, 233)]
    with ExitStack() as stack:
        assert [own_domain.own_domain(stack) for _ in usable] == usable
        with pytest.raises(MachineError, match="in use by other trials or tests: wait until one has ended"):
            own_domain.own_domain(stack)
    with ExitStack() as stack:
        assert own_domain.own_domain(stack) == 1
