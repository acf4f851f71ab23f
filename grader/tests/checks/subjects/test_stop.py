"""The check of a node's end: it runs until Ctrl-C, and stops soon after it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.outcome import Status
from grader.tests.checks.made import every, evidence, finding, good, recording
from grader.tests.checks.shapes import SHAPES
from grader.tests.checks.told import told
from grader.trial.recording import Output, ProcessEnd

if TYPE_CHECKING:
    from grader.trial.recording import Recording


@pytest.mark.parametrize("exit_code", [0, 1, -2, 130])
def test_how_a_node_ends_after_ctrl_c_does_not_matter(exit_code: int) -> None:
    text = "Traceback (most recent call last):\nrclpy._rclpy_pybind11.RCLError: failed to shutdown\n"
    end = ProcessEnd(by="SIGINT", exit_code=exit_code, t_s=10.0, stop_s=0.3)
    found = finding("stop", evidence(recording(every(0.5, 2.0, 1.0), end=end, stderr=Output(text))))
    assert found.status is Status.PASSED


@pytest.mark.parametrize(
    ("stop_s", "near", "status"), [(0.5, False, "passed"), (2.5, True, "passed"), (3.4, True, "failed")]
)
def test_a_slow_stop_is_for_wall_time_to_judge(stop_s: float, near: bool, status: str) -> None:
    end = ProcessEnd(by="SIGINT", exit_code=0, t_s=10.0, stop_s=stop_s)
    found = finding("stop", evidence(recording([], end=end)))
    assert (found.near_edge, found.status.value) == (near, status)


def test_a_node_that_did_not_stop_is_for_wall_time_to_judge() -> None:
    assert finding("stop", evidence(SHAPES["ignores Ctrl-C"]())).near_edge


def test_what_it_took_to_stop_a_node_is_reported() -> None:
    killed = SHAPES["ignores Ctrl-C"]()
    terminated = replace(killed, end=replace(killed.end, by="SIGTERM"))
    assert finding("stop", evidence(killed)).observed == "The node ignored Ctrl-C: it had to be killed."
    assert finding("stop", evidence(terminated)).observed == "The node ignored Ctrl-C: only SIGTERM ended it."


HANGS = SHAPES["ignores Ctrl-C"]()
TERMINATED = replace(HANGS, end=replace(HANGS.end, by="SIGTERM"))
SLOW = SHAPES["slow stop"]()
GREEDY = replace(HANGS, end=replace(HANGS.end, out_of="memory"))


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The node stops on Ctrl-C.", good(), SLOW),
        ("The node runs until Ctrl-C and then stops within 3 s.", SLOW, good()),
        ("The node stopped 4.0 s after Ctrl-C.", SLOW, HANGS),
        ("The node may still be waiting for something after Ctrl-C", SLOW, HANGS),
        ("The node ignored Ctrl-C: it had to be killed.", HANGS, GREEDY),
        ("The node ignored Ctrl-C: only SIGTERM ended it.", TERMINATED, HANGS),
        ("After Ctrl-C, the node was stopped by force: it used all the memory that a node may use.", GREEDY, HANGS),
    ],
)
def test_a_sentence_about_the_stop_is_true(words: str, true: Recording, near: Recording) -> None:
    assert words in told(finding("stop", evidence(true)))
    assert words not in told(finding("stop", evidence(near)))
