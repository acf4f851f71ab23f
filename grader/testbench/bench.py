"""The bench: run a student's tests on the correct node several times and on each broken node once, in random order.

The student's process reports whether the tests passed, and this process could lie. The process that runs the tests does
not know which node it tests, so a false report earns nothing: tests that always pass, always fail, or pass by chance
get no points.
"""

from __future__ import annotations

import io
import random
import tarfile
import tempfile
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING

from grader.testbench.lane import Lane, Package

if TYPE_CHECKING:
    from collections.abc import Mapping
    from concurrent.futures import Future

    from grader.exercise.node_under_test import Behaviour, TestsSpec
    from grader.ros.installation import Ros
    from grader.testbench.result import Ended

RELAYED = Path(__file__).absolute().with_name("relayed_node.py")
MOST_LANES = 4
MOST_HANGS = 2
"""If this many runs did not finish in time, no further run is started."""


class Bench:
    """The runs of one submission. `start` starts the runs in threads, and `result` waits for the runs."""

    def __init__(
        self,
        spec: TestsSpec,
        node: str,
        package: str,
        files: Mapping[str, bytes],
        ros: Ros,
        *,
        in_cell: bool,
        lanes: int,
    ) -> None:
        self._tests = Package(package, pack(spec, package, files), node)
        self._spec = spec
        self._ros = ros
        self._in_cell = in_cell
        self._count = max(1, min(lanes, MOST_LANES))
        self._queue = _Queue(spec)
        self._stack = ExitStack()
        self._opened: list[Lane] = []
        self._done: list[Future[None]] = []

    def start(self) -> None:
        """Start the cells, up to `lanes` in parallel, and the runs in them.

        If the start fails, `result` raises the error.
        """
        pool = self._stack.enter_context(ThreadPoolExecutor(self._count))
        self._done = [pool.submit(self._work) for _ in range(self._count)]

    def result(self) -> tuple[Ended, ...]:
        """Wait for all runs, and return their results.

        Raises:
            MachineError: the sandbox, pytest or rclpy does not work on this machine.
        """
        for done in self._done:
            done.result()
        return tuple(self._queue.ended)

    def close(self) -> None:
        """Stop all runs."""
        self._queue.close()
        for lane in self._opened:
            lane.kill()
        self._stack.close()

    def _work(self) -> None:
        with ExitStack() as stack:
            lane = stack.enter_context(self._lane(stack))
            self._opened.append(lane)
            while (node := self._queue.take()) is not None:
                self._queue.put(lane.run(*node))

    def _lane(self, stack: ExitStack) -> Lane:
        if self._in_cell:
            return Lane(self._ros, self._tests, self._spec.duration_s)
        folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="grader-", ignore_cleanup_errors=True))
        return Lane(self._ros, self._tests, self._spec.duration_s, Path(folder))


class _Queue:
    """The pending runs, in a random order, and the runs that have finished."""

    def __init__(self, spec: TestsSpec) -> None:
        self._waiting: list[tuple[str, Behaviour]] = [("", spec.right)] * spec.right_runs
        self._waiting += [(each.id, each.behaviour) for each in spec.broken]
        random.SystemRandom().shuffle(self._waiting)
        self._lock = Lock()
        self._closed = False
        self.ended: list[Ended] = []

    def take(self) -> tuple[str, Behaviour] | None:
        """Return the next run, or None.

        If the tests rejected the correct node, they earn no points for rejecting broken nodes. After the tests have
        rejected the correct node, all remaining runs use the correct node.
        """
        with self._lock:
            if self._closed or sum(each.over for each in self.ended) >= MOST_HANGS:
                return None
            if any(not each.node and each.exit_code != 0 for each in self.ended):
                self._waiting = [each for each in self._waiting if not each[0]]
            return self._waiting.pop() if self._waiting else None

    def put(self, ended: Ended) -> None:
        """Store the result of a run."""
        with self._lock:
            self.ended.append(ended)

    def close(self) -> None:
        """After this call, `take` returns no more runs."""
        with self._lock:
            self._closed = True


def pack(spec: TestsSpec, package: str, files: Mapping[str, bytes]) -> bytes:
    """Return the files of the package as a tar stream, with the relayed node in place of the node's module."""
    module = f"{spec.module.replace('.', '/')}.py"
    text = f"{RELAYED.read_text('utf-8')}\n\nclass {spec.name}(RelayedNode):\n    pass\n"
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode="w", format=tarfile.PAX_FORMAT) as tar:
        for path, content in {**files, module: text.encode()}.items():
            member = tarfile.TarInfo(f"{package}/{path}")
            member.size, member.mode = len(content), 0o644
            tar.addfile(member, io.BytesIO(content))
    return stream.getvalue()
