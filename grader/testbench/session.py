"""Run a student's tests in a sandbox cell repeatedly: pytest and rclpy are imported once, and each run is a fork.

This file runs as a separate script. The session reads one line of JSON and the files of the package (a tar stream) from
standard input, then one byte per run. The session writes to standard output: READY as soon as it can run tests, and
after each run the exit code of pytest, whether the time limit was exceeded, the duration (s), the report's size, and
the report. The session does not know whether a run uses the correct node or a broken one.

Between two runs, the session kills all other processes of the cell and empties the disks of the cell. Therefore, a run
finds no trace of earlier runs.
"""

from __future__ import annotations

import ctypes
import gc
import importlib
import io
import json
import os
import select
import signal
import stat
import struct
import sys
import tarfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from collections.abc import Iterator

_AHEAD = (
    *("pytest", "_pytest.assertion.rewrite", "_pytest.unittest", "_pytest.python", "_pytest.fixtures", "unittest.mock"),
    *("rclpy.action", "rclpy.executors", "rclpy.callback_groups", "rclpy.qos", "rclpy.parameter", "rclpy.time"),
)
_TYPES_AHEAD = (
    *(("geometry_msgs.msg", "Twist"), ("geometry_msgs.msg", "TwistStamped"), ("turtlesim.msg", "Pose")),
    *(("rosgraph_msgs.msg", "Clock"), ("rcl_interfaces.msg", "ParameterEvent")),
)
_HEADER = struct.Struct("<i?dI")
READY = b"ready\n"
"""The session writes this line before any of the student's code runs. A failure after this line is not the machine's
fault."""
_MOST_REPORT = 64 * 1024
_DUMPABLE, _PARENT_DEATH = 4, 1
"""PR_SET_DUMPABLE and PR_SET_PDEATHSIG of prctl(2). A run cannot inspect a session that is not dumpable."""
_GONE_S = 5.0


class _Watcher:
    """A pytest plugin that stores the results of the tests."""

    def __init__(self) -> None:
        self.collected = 0
        self.cases: list[dict[str, Any]] = []

    def pytest_collection_finish(self, session: Any) -> None:  # noqa: ANN401 - pytest's
        self.collected = len(session.items)

    def pytest_collectreport(self, report: Any) -> None:  # noqa: ANN401 - pytest's
        if report.failed:
            self.cases.append({"name": report.nodeid, "outcome": "import", **_details(report)})

    def pytest_runtest_logreport(self, report: Any) -> None:  # noqa: ANN401 - pytest's
        if report.when == "call" or report.outcome != "passed":
            outcome = report.outcome if report.when == "call" or report.outcome == "skipped" else report.when
            self.cases.append({"name": report.nodeid, "outcome": outcome, **_details(report)})

    def report(self) -> bytes:
        """Return the report as JSON: the number of tests that were found, and the tests that ran."""
        return json.dumps({"collected": self.collected, "cases": self.cases[-50:]}).encode()


def _details(report: Any) -> dict[str, Any]:  # noqa: ANN401 - pytest's
    if report.outcome == "passed":
        return {}
    crash = getattr(report.longrepr, "reprcrash", None)
    if crash is None:
        return {"message": str(report.longrepr)[-1500:], "file": "", "line": 0}
    return {"message": str(crash.message)[:1500], "file": str(crash.path), "line": int(crash.lineno)}


def main() -> None:
    """Import everything, and run the tests once per byte of standard input."""
    sys.path.pop(0)
    for name in _AHEAD:
        importlib.import_module(name)
    for name, message in _TYPES_AHEAD:
        type(getattr(importlib.import_module(name), message)).__import_type_support__()
    orders = sys.stdin.buffer
    order = json.loads(orders.readline())
    source = orders.read(order["size"])
    disks = [_Disk(Path(folder)) for folder in order["disks"]]
    ctypes.CDLL(None).prctl(_DUMPABLE, 0, 0, 0, 0)
    gc.freeze()
    os.write(1, READY)
    while orders.read(1):
        _empty_pipe(order["answers"])
        begun = time.monotonic()
        child = os.fork()
        if child == 0:
            _run_tests(order, source)
        over = not _ended(child, order["duration_s"])
        if over:
            os.kill(child, signal.SIGKILL)
        status = os.waitpid(child, 0)[1]
        code = os.waitstatus_to_exitcode(status)
        report = _report(Path(order["workspace"], "report.json"))
        seconds = time.monotonic() - begun
        _end_all(None if order["in_cell"] else child)
        for disk in disks:
            disk.empty()
        os.write(1, _HEADER.pack(code, over, seconds, len(report)) + report)


def _ended(child: int, within_s: float) -> bool:
    descriptor = os.pidfd_open(child)
    try:
        return bool(select.select([descriptor], [], [], within_s)[0])
    finally:
        os.close(descriptor)


def _run_tests(order: dict[str, Any], source: bytes) -> NoReturn:
    """Run the tests of the package as `colcon test` does: pytest, in the folder of the package."""
    code: int = 1
    try:
        ctypes.CDLL(None).prctl(_DUMPABLE, 1, 0, 0, 0)
        # Without a cell, nothing else stops a run whose session is killed.
        ctypes.CDLL(None).prctl(_PARENT_DEATH, signal.SIGKILL, 0, 0, 0)
        os.setpgid(0, 0)
        null = os.open(os.devnull, os.O_RDWR)
        for number in (0, 1, 2):
            os.dup2(null, number)
        workspace = Path(order["workspace"])
        package = workspace / "src" / order["package"]
        Path(order["home"]).mkdir(parents=True, exist_ok=True)
        with tarfile.open(fileobj=io.BytesIO(source)) as tree:
            # A malicious member can do no harm in a cell, and the Python of Debian 12 has no extraction filters yet.
            tree.extraction_filter = lambda member, _path: member
            tree.extractall(workspace / "src")
        os.chdir(package)
        os.environ.update(order["env"])
        sys.path.insert(0, str(package))
        sys.argv = ["pytest"]
        importlib.invalidate_caches()
        signal.pthread_sigmask(signal.SIG_SETMASK, ())
        signal.signal(signal.SIGINT, signal.default_int_handler)
        import pytest

        watcher = _Watcher()
        code = int(pytest.main(["-q", "--maxfail=1", "-p", "no:cacheprovider", "--color=no"], plugins=[watcher]))
        (workspace / "report.json").write_bytes(watcher.report()[:_MOST_REPORT])
    finally:
        os._exit(code)


def _report(file: Path) -> bytes:
    """Return the report of the run, or empty bytes if there is no regular file."""
    try:
        descriptor = os.open(file, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK)
    except OSError:
        return b""
    try:
        return os.read(descriptor, _MOST_REPORT) if stat.S_ISREG(os.fstat(descriptor).st_mode) else b""
    finally:
        os.close(descriptor)


def _empty_pipe(pipe: int) -> None:
    """Discard answers that an earlier run did not read."""
    while select.select([pipe], [], [], 0.0)[0] and os.read(pipe, 65536):
        pass


def _end_all(group: int | None) -> None:
    """Kill all other processes of the cell. Outside a cell, kill all other processes of this process group."""
    until = time.monotonic() + _GONE_S
    try:
        while time.monotonic() < until:
            os.kill(-1 if group is None else -group, signal.SIGKILL)
            time.sleep(0.002)
    except ProcessLookupError:
        return
    sys.exit("the processes of a run could not be ended")


class _Disk:
    """A disk of the cell. The initial entries of the disk are kept, because other disks are mounted there."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._device = folder.stat().st_dev
        self._first = set(self._entries(folder))

    def empty(self) -> None:
        """Remove everything that a run left behind. Exit if something remains, because the next run could find it."""
        # in this order, the contents of a folder are removed before the folder itself
        for path in sorted(self._entries(self._folder), reverse=True):
            if path in self._first:
                path.chmod(0o755)
                os.utime(path, (0, 0))
            elif path.is_dir() and not path.is_symlink():
                path.rmdir()
            else:
                path.unlink()
        self._folder.chmod(0o755)
        os.utime(self._folder, (0, 0))
        if set(self._entries(self._folder)) != self._first:
            sys.exit("the disks of the cell could not be emptied")

    def _entries(self, folder: Path) -> Iterator[Path]:
        """Yield all files and folders on this disk that are below the given folder."""
        for path in folder.iterdir():
            about = path.lstat()
            if about.st_dev != self._device:
                continue
            yield path
            if stat.S_ISDIR(about.st_mode):
                path.chmod(0o755)
                yield from self._entries(path)


main()
