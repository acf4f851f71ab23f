"""The time limits for a node that is not idle in simulated time."""

from __future__ import annotations

import time
from contextlib import closing
from typing import cast

import pytest

from grader.tests.trial.program import python
from grader.trial import patience
from grader.trial.patience import TICK_S, HandshakePatience, TickPatience
from grader.trial.rest import Threads

LOOK_S = 0.5
LOOPS = "print('ready', flush=True)\nwhile True: pass"
PLAYS = """
import threading
one, other = threading.Event(), threading.Event()
def play(mine, theirs):
    while True:
        mine.wait()
        mine.clear()
        theirs.set()
threading.Thread(target=play, args=(one, other)).start()
one.set()
print("ready", flush=True)
play(other, one)
"""


def waited(*, asleep: float, wrote: bool = False, share: float = 0.0) -> float:
    """Return the time (s) after which the trial stops waiting for a node.

    The node sleeps in the share `asleep` of all observations, and uses the share `share` of a processor.
    """
    patience, now_s, observed = HandshakePatience(0.0), 0.0, 0.0
    while True:
        now_s += LOOK_S
        observed += asleep
        sleeps = observed >= 1.0
        observed -= sleeps
        if patience.ended(now_s, asleep=sleeps, wrote=wrote, worked_s=share * now_s):
            return now_s


@pytest.mark.parametrize(
    ("least_s", "most_s", "asleep", "wrote", "share"),
    [
        (20.0, 21.0, 1.0, False, 0.0),  # the node sleeps, or waits for something that never happens
        (20.0, 25.0, 0.9, False, 0.05),  # a loop that polls from time to time
        (20.0, 21.0, 0.0, False, 1.0),  # the node always works and has a processor for itself
        (80.0, 81.0, 0.0, False, 0.25),  # with a quarter of a processor, the node may use as much CPU time
        (100.0, 101.0, 0.0, False, 0.05),
        (80.0, 81.0, 1.0, True, 0.25),  # the node sleeps because we read its output too slowly
        (100.0, 101.0, 1.0, True, 0.05),
    ],
)
def test_only_sleep_and_work_are_counted(
    least_s: float, most_s: float, asleep: float, wrote: bool, share: float
) -> None:
    assert least_s < waited(asleep=asleep, wrote=wrote, share=share) <= most_s


class Worker:
    """A fake process for `TickPatience`: each request returns the next CPU time (s)."""

    def __init__(self, *reported_s: float) -> None:
        self._reported_s = list(reported_s)

    def run_time_s(self) -> float:
        return self._reported_s.pop(0)

    def run_times_s(self) -> dict[int, float]:
        return {}


def test_a_node_that_works_on_at_one_instant_ends_patience() -> None:
    patience = TickPatience(cast("Threads", Worker(7.0, 7.0, 7.9, 8.1)), 0.0)
    assert not patience.ended(0.01)  # it is too early for a request, and the process has only four answers
    assert [patience.ended(now_s) for now_s in (0.1, 0.11, 0.2, 0.21, 0.3)] == [False, False, False, False, True]


@pytest.mark.parametrize(("worked_s", "late"), [(0.29, False), (0.31, True)])
def test_a_node_that_computes_for_long_at_one_instant_would_be_late(worked_s: float, *, late: bool) -> None:
    patience = TickPatience(cast("Threads", Worker(7.0, 7.0, 7.0 + worked_s)), 0.0)
    assert not patience.would_be_late()  # the CPU time has not been read yet
    assert not patience.ended(0.1)
    assert patience.would_be_late() == late


def test_a_node_that_only_wakes_and_sleeps_ends_patience_by_time() -> None:
    patience = TickPatience(cast("Threads", Worker(7.0, 7.0, 7.0)), 0.0)
    assert [patience.ended(now_s) for now_s in (TICK_S - 1.0, TICK_S + 1.0)] == [False, True]


@pytest.mark.parametrize(
    ("code", "several"), [(LOOPS, False), (PLAYS, True)], ids=["a loop", "threads wake each other"]
)
def test_threads_that_wake_each_other_are_no_loop(code: str, several: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(patience, "TICK_CPU_S", 0.1)
    with python(code) as process, closing(Threads(process.pid)) as threads:
        node = TickPatience(threads, time.monotonic())
        while not node.ended(time.monotonic()):
            time.sleep(0.001)
        assert node.several_worked() == several
