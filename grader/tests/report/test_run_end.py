"""The sentence of a page about how the node's process ended."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import pytest

from grader.report.html_run import runs_of
from grader.tests.checks.made import evidence, good


def end_of(by: Literal["itself", "SIGINT"], exit_code: int, out_of: str | None) -> str:
    end = replace(good().end, by=by, exit_code=exit_code, t_s=3.0, out_of=out_of)
    return runs_of([evidence(replace(good(), end=end))])[0].end


@pytest.mark.parametrize(("by", "when"), [("itself", " after 3.0 s"), ("SIGINT", "")])
def test_a_node_that_exceeded_a_limit_is_not_said_to_have_exited_on_its_own(
    by: Literal["itself", "SIGINT"], when: str
) -> None:
    words = f"The node was killed{when}, because it used all the memory that a node may use."
    assert end_of(by, -9, "memory") == words


def test_the_other_ends_have_an_exit_code_as_in_a_shell() -> None:
    assert end_of("itself", -9, None) == "The node exited on its own after 3.0 s, with exit code 137."
    assert end_of("SIGINT", 0, None) == "The node stopped on Ctrl-C, with exit code 0."
