"""The measurement of crowds and stalls, with real processes.

Some tests that need exact numbers use invented numbers.
"""

from __future__ import annotations

import os
from contextlib import closing, contextmanager
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import pytest

from grader.tests.trial.program import python
from grader.trial import conductor, crowd
from grader.trial.crowd import Others, Stalls, is_crowded, is_machines
from grader.trial.recording import Message

if TYPE_CHECKING:
    import subprocess
    from collections.abc import Iterable, Iterator, Sequence

WORK_S = 0.5
"""The CPU time that a program uses when it is told to work (s). The kernel counts in steps of 0.01 s or finer."""
WORKS = """
import os, sys, time
os.sched_setaffinity(0, {{{processor}}})
print("ready", flush=True)
for _ in sys.stdin:
    until_s = time.process_time() + {work_s}
    while time.process_time() < until_s:
        pass
    print("worked", flush=True)
"""


@contextmanager
def program(work_s: float) -> Iterator[subprocess.Popen[str]]:
    """Yield a program that uses this CPU time (s) for each line of input.

    All programs of this kind share one processor.
    """
    code = WORKS.format(processor=min(os.sched_getaffinity(0)), work_s=work_s)
    with python(code) as process:
        yield process


def begin(process: subprocess.Popen[str]) -> None:
    assert process.stdin is not None
    process.stdin.write("\n")
    process.stdin.flush()


def work(process: subprocess.Popen[str]) -> None:
    begin(process)
    assert process.stdout is not None
    assert process.stdout.readline() == "worked\n"


def test_what_another_program_works_is_counted() -> None:
    with program(WORK_S) as other:
        others = Others()
        work(other)
        assert others.worked_s(but_s=0.0) >= WORK_S / 2


def test_what_simulator_and_node_work_is_not_that_of_others(monkeypatch: pytest.MonkeyPatch) -> None:
    machine, own = iter([100.0, 107.0]), iter([1.0, 3.0])
    monkeypatch.setattr(crowd, "_machine_worked_s", lambda: next(machine))
    monkeypatch.setattr("time.process_time", lambda: next(own))
    assert Others().worked_s(but_s=4.0) == pytest.approx(7.0 - 2.0 - 4.0)


def test_a_node_that_shares_its_processor_waits_and_is_observed_waiting() -> None:
    with program(WORK_S) as node, program(3600.0) as rival:
        with closing(Stalls(node.pid)) as watch:
            begin(rival)
            work(node)
            watch.look(1.0)
        assert watch.waited_s >= WORK_S / 5


@pytest.mark.parametrize(
    ("waited_s", "others_s", "crowded"),
    [(0.5, 2.0, True), (0.4, 8.0, False), (8.0, 1.9, False), (0.0, 0.0, False)],
    ids=["both", "nobody waited", "nobody else worked", "an idle machine"],
)
def test_a_machine_is_crowded_where_others_work_and_ours_wait(
    waited_s: float, others_s: float, *, crowded: bool
) -> None:
    assert is_crowded(waited_s, others_s, of_s=10.0) == crowded


def test_stalls_without_other_programs_are_the_nodes_own() -> None:
    assert is_machines(0.5, others_s=0.5)
    assert not is_machines(0.5, others_s=0.1)


Counts = tuple[tuple[float, float], tuple[float, float], float]
"""The values (ran, waited) of the node and of the simulator, and the stolen time, since the last observation (s)."""


@pytest.mark.parametrize(
    ("counts", "stall"),
    [
        (((0.01, 0.0), (0.01, 0.0), 0.0), False),
        (((0.01, 0.05), (0.01, 0.0), 0.0), True),
        (((0.01, 0.0), (0.01, 0.05), 0.0), True),
        (((0.01, 0.0), (0.01, 0.0), 0.05), True),
        (((0.09, 0.05), (0.01, 0.0), 0.0), False),
        (((0.01, 0.05), (0.09, 0.05), 0.0), False),
        (((0.04, 0.05), (0.05, 0.05), 0.0), False),
        (((0.04, 0.05), (0.03, 0.05), 0.0), True),
        (((0.09, 0.05), (0.09, 0.05), 0.05), True),
    ],
    ids=[
        "all in time",
        "the node waited",
        "ours waited",
        "stolen",
        "the node's own doing",
        "the simulator was busy for the node",
        "the two together",
        "the simulator's own share",
        "stolen while they worked",
    ],
)
def test_a_stall_is_what_the_machine_owes(counts: Counts, monkeypatch: pytest.MonkeyPatch, *, stall: bool) -> None:
    with looked(counts, monkeypatch) as watch:
        assert watch.look(0.1) == ((0.0, 0.1) if stall else None)


def looked(counts: Counts, monkeypatch: pytest.MonkeyPatch) -> closing[Stalls]:
    """Return a Stalls object that will find these counts when it next measures."""
    node, simulator, stolen_s = counts
    return measured([({1: node}, {2: simulator}, stolen_s)], monkeypatch)


def measured(
    found: Sequence[tuple[crowd.Times, crowd.Times, float]], monkeypatch: pytest.MonkeyPatch
) -> closing[Stalls]:
    """Return a Stalls object that will find these times of the node, the simulator and the hypervisor."""
    nothing: crowd.Times = {}
    times = iter([nothing, nothing, *(part for node, simulator, _ in found for part in (node, simulator))])
    stolen = iter([0.0, 0.0, *(stolen_s for _, _, stolen_s in found)])
    monkeypatch.setattr(crowd, "_times", lambda _: next(times))
    monkeypatch.setattr(crowd, "_stolen_s", lambda: next(stolen))
    return closing(Stalls(os.getpid()))


def test_a_stall_begins_where_the_wait_began(monkeypatch: pytest.MonkeyPatch) -> None:
    """The kernel counts a wait when it ends. Then, a node that loops may run for a whole frame."""
    waits, runs = ({1: (0.0, 0.0)}, {2: (0.0, 0.0)}, 0.0), ({1: (0.015, 1.2)}, {2: (0.001, 0.0)}, 0.0)
    with measured([waits, runs], monkeypatch) as watch:
        assert watch.look(1.984) is None
        stall = watch.look(2.0)
    assert stall is not None
    assert stall == pytest.approx((0.8, 2.0))
    of: Any = Busy(0.015, 0.0)
    assert not conductor._own_doing(stall, of, of)


def test_a_short_wait_is_a_stall_of_one_frame(monkeypatch: pytest.MonkeyPatch) -> None:
    waits, runs = ({1: (0.0, 0.0)}, {2: (0.0, 0.0)}, 0.0), ({1: (0.005, 0.2)}, {2: (0.001, 0.0)}, 0.0)
    with measured([waits, runs], monkeypatch) as watch:
        assert watch.look(1.984) is None
        assert watch.look(2.0) == (1.984, 2.0)


def test_a_stall_is_as_long_as_the_longest_wait_of_a_thread_and_not_as_all_waits(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    together: crowd.Times = {1: (0.0, 0.4), 3: (0.0, 0.3), 4: (0.0, 0.4)}
    with measured([({}, {}, 0.0), (together, {}, 0.0), ({}, {2: (0.0, 0.9)}, 0.0)], monkeypatch) as watch:
        assert watch.look(1.984) is None
        assert watch.look(2.0) == pytest.approx((1.6, 2.0))
        assert watch.waited_s == pytest.approx(1.1)
        assert watch.look(2.5) == (2.0, 2.5)  # no part of the time is in two stalls


def test_what_the_simulator_works_beyond_its_own_share_is_the_nodes(monkeypatch: pytest.MonkeyPatch) -> None:
    with looked(((0.01, 0.0), (0.08, 0.0), 0.0), monkeypatch) as watch:
        watch.look(0.1)
    assert watch.worked_for_node_s(0.0, 0.1) == pytest.approx(0.08 - crowd.SIMULATOR * 0.1)
    assert watch.worked_for_node_s(0.1, 0.2) == 0.0


class Busy:
    """An object that replaces both a node and a trial in tests.

    Every request returns the CPU times with which the object was created (s).
    """

    def __init__(
        self,
        node_s: float,
        simulator_s: float,
        requests: int = 0,
        messages: Iterable[str] = (),
        started_s: float = 0.0,
    ) -> None:
        self._node_s, self._simulator_s, self.requests, self._started_s = node_s, simulator_s, requests, started_s
        made = [Message(topic, "std_msgs/msg/String", b"", 0.0, 0.0) for topic in messages]
        self.recorder = SimpleNamespace(messages=made, dropped=0)

    def worked_s(self, *_: float) -> float:
        return self._node_s

    def started_ready_s(self) -> float:
        return self._started_s

    def worked_for_node_s(self, *_: float) -> float:
        return self._simulator_s

    def now(self) -> float:
        return 10.0


@pytest.mark.parametrize(
    ("node_s", "simulator_s", "own"), [(0.0, 0.0, False), (0.06, 0.0, True), (0.0, 0.06, True), (0.03, 0.03, True)]
)
def test_a_stall_while_node_and_its_requests_take_the_time_is_the_nodes(
    node_s: float, simulator_s: float, *, own: bool
) -> None:
    of: Any = Busy(node_s, simulator_s)
    assert conductor._own_doing((1.0, 1.1), of, of) == own


@pytest.mark.parametrize(("requests", "own"), [(1900, False), (5000, True)])
def test_stalls_beside_thousands_of_requests_are_the_nodes_however_little_time_both_got(
    requests: int, *, own: bool
) -> None:
    of: Any = Busy(0.0, 0.0, requests)
    assert conductor._own_doing((1.0, 1.1), of, of) == own


@pytest.mark.parametrize(
    ("topic", "count", "own"), [("/noise", 5000, False), ("/noise", 10_000, True), ("/leo/pose", 10_000, False)]
)
def test_stalls_beside_a_flood_of_messages_are_the_nodes_however_little_time_both_got(
    topic: str, count: int, *, own: bool
) -> None:
    of: Any = Busy(0.0, 0.0, messages=[topic] * count)
    assert conductor._own_doing((1.0, 1.1), of, of) == own


@pytest.mark.parametrize(
    ("processors", "started_s", "own"), [(2, 10.0, False), (2, 18.0, True), (8, 18.0, False), (8, 36.0, True)]
)
def test_stalls_beside_processes_that_could_use_the_machine_alone_are_the_nodes(
    monkeypatch: pytest.MonkeyPatch, processors: int, started_s: float, *, own: bool
) -> None:
    monkeypatch.setattr("os.sched_getaffinity", lambda _: set(range(processors)))
    of: Any = Busy(0.0, 0.0, started_s=started_s)
    assert conductor._own_doing((1.0, 1.1), of, of) == own
