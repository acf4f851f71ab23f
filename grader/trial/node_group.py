"""The processes of all nodes of one trial, which start, run and stop together."""

from __future__ import annotations

import time
from contextlib import closing
from typing import TYPE_CHECKING

from grader.trial.rest import GoneError, Look, Threads

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from grader.trial.node_process import NodeProcess
    from grader.trial.wait import Wait


SETTLES_S = 1.0
"""The maximum time that a node gets to handle the departure of another node before it is stopped (s)."""


class NodeGroup:
    """The nodes of a trial: first the trial's own node, then the additional nodes."""

    def __init__(self, processes: Sequence[NodeProcess]) -> None:
        self.processes = tuple(processes)
        self._stopping = False
        self._interrupted: set[int] = set()
        self._waiting_since_s: dict[int, float] = {}

    @property
    def pids(self) -> tuple[int, ...]:
        """The process ids of the nodes."""
        return tuple(process.pid for process in self.processes)

    def await_ready(self) -> None:
        """Wait until all launchers are ready. Raises LaunchError if a launcher exited."""
        for process in self.processes:
            process.await_ready()

    def start(self, orders: Sequence[dict[str, object]], tree: bytes) -> None:
        """Send each launcher the install tree and the data about its node."""
        for process, order in zip(self.processes, orders, strict=True):
            process.start(order, tree)

    def ended(self) -> bool:
        """Return whether at least one of the processes has exited."""
        return any(process.ended() for process in self.processes)

    def all_ended(self) -> bool:
        """Return whether all of the processes have exited."""
        return all(process.ended() for process in self.processes)

    def ended_itself(self) -> bool:
        """Return whether the trial's own node exited before `stop`. Call this after the node has exited."""
        return self.processes[0].ended_itself

    def stop(self) -> None:
        """Stop the nodes with Ctrl-C, one after the other. Call this method repeatedly until all have exited.

        If a node destroys its participant while it handles the departure of another participant, it never exits, with
        Fast DDS 2.14: DomainParticipant::set_listener, which rmw_fastrtps calls without a time limit, then waits in a
        loop and holds the lock that the other thread needs, because its deadline overflows. This happened to 1 of 230
        nodes that were stopped at the same time.
        """
        if not self._stopping:
            self._stopping = True
            for process in self.processes:
                process.scenario_is_over()
        running = [process for process in self.processes if not process.ended()]
        for process in running[:1]:
            if process.pid in self._interrupted:
                process.escalate()
            elif len(running) == len(self.processes) or self._has_settled(process.pid):
                self._interrupted.add(process.pid)
                process.interrupt()

    def _has_settled(self, pid: int) -> bool:
        """Return whether a process has handled the departure of the other nodes: all of its threads sleep.

        SETTLES_S after the first call, return True in any case.
        """
        first_s = self._waiting_since_s.setdefault(pid, time.monotonic())
        return _sleeps(pid) or time.monotonic() > first_s + SETTLES_S

    def read_output(self, now_s: float) -> int:
        """Read and store the new output with the arrival time `now_s`, and return the number of bytes."""
        return sum(process.read_output(now_s) for process in self.processes)

    def waited_to_write(self, size: int) -> bool:
        """Return whether a full pipe might have delayed a node. `size` is the number of bytes that all nodes wrote."""
        return any(process.waited_to_write(size) for process in self.processes)

    def worked_s(self, begin: float, end: float) -> float:
        """Return the CPU time that all processes used between two times of CLOCK_MONOTONIC (s)."""
        return sum(process.worked_s(begin, end) for process in self.processes)

    def started_ready_s(self) -> float:
        """Return the total time (s) for which the processes started by the nodes ran or waited for a processor."""
        return sum(process.started_ready_s() for process in self.processes)

    def has_started_others(self) -> bool:
        """Return whether a process that a node started is running, as far as this was observed."""
        return any(process.has_started_others() for process in self.processes)


def _sleeps(pid: int) -> bool:
    """Return whether no thread of a process has run between two observations, or whether the process has exited.

    If the process has more threads than this process can observe, return False.
    """
    try:
        with closing(Threads(pid)) as threads:
            first, second = threads.look(), threads.look()
    except GoneError:
        return True
    except OSError:  # too many open files
        return False
    return first.asleep and first == second


class GroupThreads:
    """The threads of several processes, with the methods of `Threads`.

    All methods except `close` and `cpu_ns` can raise GoneError, which means that one of the processes has exited.
    """

    def __init__(self, pids: Sequence[int], wanted: Callable[[str], bool] = lambda _: True) -> None:
        self._each: list[Threads] = []
        try:
            for pid in pids:
                self._each.append(Threads(pid, wanted))
        except GoneError:
            self.close()
            raise

    def close(self) -> None:
        """Close the files in /proc."""
        for threads in self._each:
            threads.close()

    def look(self) -> Look:
        """Read the state of every thread once."""
        looks = self.looks()
        return Look(all(look.asleep for look in looks), sum((look.runs for look in looks), ()))

    def looks(self) -> list[Look]:
        """Read the state of every thread once, and return the result for each process."""
        return [threads.look() for threads in self._each]

    def cpu_ns(self) -> tuple[int, ...]:
        """Return the CPU time that each process has used (ns), which has grown if a thread has run."""
        return sum((threads.cpu_ns() for threads in self._each), ())

    def asleep(self) -> bool:
        """Return whether every thread of every process is sleeping."""
        return all(threads.asleep() for threads in self._each)

    def main_asleep(self) -> bool:
        """Return whether all main threads are sleeping."""
        return all(threads.main_asleep() for threads in self._each)

    def run_time_s(self) -> float:
        """Return the CPU time (s) that all threads have used."""
        return sum(threads.run_time_s() for threads in self._each)

    def run_times_s(self) -> dict[int, float]:
        """Return the CPU time (s) that each thread has used, by thread id, without the threads of Fast DDS."""
        return {tid: ran_s for threads in self._each for tid, ran_s in threads.run_times_s().items()}

    def times_s(self) -> dict[int, tuple[float, float]]:
        """Return the times (s) for which each thread has run and waited for a processor, by thread id."""
        return {tid: times for threads in self._each for tid, times in threads.times_s().items()}

    def waits(self) -> list[Wait]:
        """Return the reason why each thread is waiting, except for the threads of Fast DDS."""
        return [wait for threads in self._each for wait in threads.waits()]


def cpu_ns_at_rest(*each: Threads | GroupThreads) -> list[tuple[int, ...]] | None:
    """Return the CPU times (ns) if all threads are asleep and none has run meanwhile. Otherwise, return None.

    A thread that has woken another one and falls asleep is in state S a moment before its CPU time grows. If it is held
    up in this moment, for example because the host of a virtual machine takes the processor away, it appears to have
    slept all the time. The other thread may have been looked at before it was woken. The second look shows that it is
    awake. When a BPF program held up every fourth such moment for up to 0.4 ms, a single look let the clock advance too
    early about 8 times in 37,500 frames, and two looks never did in 65,000.

    Raises:
        GoneError: a process has exited.
    """
    before = [threads.cpu_ns() for threads in each]
    asleep = all(threads.asleep() for threads in each * 2)
    return before if asleep and [threads.cpu_ns() for threads in each] == before else None
