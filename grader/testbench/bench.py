"""Run a student's tests on the correct node several times and on each broken node once, in random order.

Runs that are no longer needed are left out (see `_Queue.take`).

The student's process reports whether the tests passed, and its report could be false. This process does not know which
node it tests, so a false report gains little. Tests that always pass or always fail get no points for broken nodes, and
tests that pass by chance get few points (docs/security.md).
"""

from __future__ import annotations

import ast
import io
import random
import re
import tarfile
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING

from grader.common.temporary_folder import temporary_folder
from grader.submission.code import read_module
from grader.submission.reader import read
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
"""If this many runs on broken nodes did not finish in time, no further run on a broken node is started."""
RIGHT_S = 5.0
"""The time limit for each test on the correct node (s).

On a broken node, a test may need more time, because it may wait for a message that never arrives.
"""
_MORE_PARTICIPANTS = re.compile(
    rb"Context\b|\b(?:concurrent|exec[lv]\w*|fork\w*|launch\w*|multiprocessing|popen|posix_spawnp?|pty)\b"
    rb"|\b(?:spawn[lv]\w*|subprocess|system)\b"
)
"""Matches names that code must contain to create a second ROS 2 context or a second process."""
NO_OPTIONS = "def __init__(self):\n        super().__init__()"
"""The body of the grader's class if the student's own class has no parameters."""
DOUBT_S = 1.0
"""The time limit for each test on a broken node (s), as long as no run on the correct node has ended."""


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
        self._tests = Package(package, pack(spec, package, files), node, alone=uses_one_participant(files))
        self._spec = spec
        self._ros = ros
        self._in_cell = in_cell
        self._count = max(1, min(lanes, MOST_LANES))
        self._queue = _Queue(spec)
        self._stack = ExitStack()
        self._opened: list[Lane] = []
        self._done: list[Future[None]] = []

    def start(self) -> None:
        """Start the cells and the runs in them. The number of parallel cells is `lanes`, but at most MOST_LANES.

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
        self._kill_lanes()
        self._stack.close()

    def _kill_lanes(self) -> None:
        for lane in self._opened:
            lane.kill()

    def _work(self) -> None:
        with ExitStack() as stack:
            lane = stack.enter_context(self._lane(stack))
            self._opened.append(lane)
            while (next_ := self._queue.take()) is not None:
                self._queue.put(next_, lane.run(next_.node, next_.behaviour, next_.test_s))
                if self._queue.is_settled:
                    self._kill_lanes()

    def _lane(self, stack: ExitStack) -> Lane:
        if self._in_cell:
            return Lane(self._ros, self._tests, self._spec.duration_s)
        folder = stack.enter_context(temporary_folder())
        return Lane(self._ros, self._tests, self._spec.duration_s, folder)


@dataclass(frozen=True)
class _Next:
    """A run: the id of a broken node (or "" for the correct node), its behaviour, and the time limit per test (s)."""

    node: str
    behaviour: Behaviour
    test_s: float = RIGHT_S


class _Queue:
    """The pending runs, in a random order, and the runs that have finished."""

    def __init__(self, spec: TestsSpec) -> None:
        self._spec = spec
        self._waiting = [_Next("", spec.right)] * spec.right_runs
        self._waiting += [_Next(each.id, each.behaviour) for each in spec.broken]
        random.SystemRandom().shuffle(self._waiting)
        self._lock = Lock()
        self._closed = False
        self._doubts = False
        """Whether a run exceeded its time limit. If so, the tests may also hang on the correct node."""
        self.ended: list[Ended] = []

    @property
    def is_settled(self) -> bool:
        """Whether a run on the correct node exceeded its time limit. If so, no other run can change a verdict."""
        return any(each.over and not each.node for each in self.ended)

    def take(self) -> _Next | None:
        """Return the next run, or None if no further run is needed.

        If the tests have rejected the correct node, they earn no points for rejecting broken nodes. Therefore, only the
        remaining runs on the correct node are started after that, or after MOST_HANGS runs have exceeded their time. If
        the tests may hang on the correct node, and no run on the correct node has ended, the next run is an additional
        run on this node. This run is not one of the pending runs: otherwise, tests could choose when one of these takes
        place.
        """
        with self._lock:
            rights = [each for each in self.ended if not each.node]
            if self._closed or self.is_settled:
                return None
            if self._doubts and not rights:
                return _Next("", self._spec.right)
            hangs = sum(each.over for each in self.ended)
            if hangs >= MOST_HANGS or any(each.exit_code != 0 for each in rights):
                self._waiting = [each for each in self._waiting if not each.node]
            if not self._waiting:
                return None
            next_ = self._waiting.pop()
            return replace(next_, test_s=self._spec.duration_s if rights else DOUBT_S) if next_.node else next_

    def put(self, run: _Next, ended: Ended) -> None:
        """Store the result of a run.

        A run that exceeded the short time limit `DOUBT_S` without being stuck is not stored, but repeated later.
        """
        with self._lock:
            if self._closed or self.is_settled:
                return
            self._doubts |= ended.over
            if ended.over and not ended.stuck and run.node and run.test_s == DOUBT_S:
                self._waiting.insert(random.SystemRandom().randint(0, len(self._waiting)), run)
            else:
                self.ended.append(ended)

    def close(self) -> None:
        """After this call, `take` returns no more runs."""
        with self._lock:
            self._closed = True


def uses_one_participant(files: Mapping[str, bytes]) -> bool:
    """Return whether all nodes of a run are in one process and one ROS 2 context, so that they need no discovery.

    If the code might create more contexts or processes, the result is False.
    """
    return not any(_MORE_PARTICIPANTS.search(text) for path, text in files.items() if _is_module(path))


def _is_module(path: str) -> bool:
    return path.endswith(".py") and path != "setup.py"


def takes_options(files: Mapping[str, bytes], file: str, name: str) -> bool:
    """Return whether __init__ of the student's own class has parameters besides self.

    If it has none, the grader's class must have none either: otherwise, tests pass that fail in the student's
    workspace. The result is True if the file or the class has no such method.
    """
    for node in read_module(file, files.get(file, b"")).nodes:
        if isinstance(node, ast.ClassDef) and node.name == name:
            for method in node.body:
                if isinstance(method, ast.FunctionDef) and method.name == "__init__":
                    given = method.args
                    named = [*given.posonlyargs, *given.args][1:] + given.kwonlyargs
                    return bool(named or given.vararg or given.kwarg)
    return True


def pack(spec: TestsSpec, package: str, files: Mapping[str, bytes]) -> bytes:
    """Return the files of the package as a tar stream, with the relayed node in place of the node's module."""
    module = f"{spec.module.replace('.', '/')}.py"
    body = "pass" if read(takes_options, files, module, spec.name) else NO_OPTIONS
    text = f"{RELAYED.read_text('utf-8')}\n\nclass {spec.name}(RelayedNode):\n    {body}\n"
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode="w", format=tarfile.PAX_FORMAT) as tar:
        for path, content in {**files, module: text.encode()}.items():
            member = tarfile.TarInfo(f"{package}/{path}")
            member.size, member.mode = len(content), 0o644
            tar.addfile(member, io.BytesIO(content))
    return stream.getvalue()
