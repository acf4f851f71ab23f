"""Run a student's tests repeatedly: pytest and rclpy are imported once, and each run is a fork in a new sandbox cell.

This file runs as a separate script, usually in a sandbox room. The session reads one line of JSON and the files of the
package (a tar stream) from standard input. As soon as the session can run tests, it writes READY to standard output.
Each request is a message on a Unix socket with three descriptors: the run's two pipes to the grader, and a socket for
the result. On this socket, the session sends STARTED with a descriptor of the process that runs the tests
(pidfd_open(2)). At the end, the session sends the exit code of pytest, the duration (s), the report's size, and the
report. The session does not know whether a run uses the correct node or a broken one.

bubblewrap creates the cell, and a fork of the session enters it (grader.sandbox.entering). The session itself receives
nothing from its runs: the fork reports to the grader, and ends together with its cell. Therefore, neither a cell nor
the memory of a run contains a trace of an earlier run.
"""

from __future__ import annotations

import base64
import gc
import importlib
import io
import json
import os
import shutil
import signal
import socket
import stat
import struct
import sys
import tarfile
import tempfile
import time
from pathlib import Path
from typing import Any, NoReturn

from grader.common.linux_calls import adopt_orphans, pidfd_open
from grader.sandbox import entering
from grader.sandbox.holder import Holder

_AHEAD = (
    *("pytest", "_pytest.assertion.rewrite", "pdb", "unittest.mock"),
    *("rclpy.action", "rclpy.executors", "rclpy.callback_groups", "rclpy.qos", "rclpy.parameter", "rclpy.time"),
)
_TYPES_AHEAD = (
    *(("geometry_msgs.msg", "Twist"), ("geometry_msgs.msg", "TwistStamped"), ("turtlesim.msg", "Pose")),
    *(("rosgraph_msgs.msg", "Clock"), ("rcl_interfaces.msg", "ParameterEvent")),
    ("type_description_interfaces.srv", "GetTypeDescription"),
)
_HEADER = struct.Struct("<idI")
READY = b"ready\n"
"""The session writes this line when it has imported everything, before any of the student's code runs."""
STARTED = b"s"
FILTER = 100
"""The descriptor of the call filter in the command line of a cell."""
ASKS, ANSWERS = 3, 4
"""The descriptors of a run: its requests to the grader, and the grader's responses."""
_TEST_ENDED = struct.pack("<cHqdd", b"d", 0, 0, 0.0, 0.0)
"""The message that a test has ended. It needs no response. See conversation.py."""
_MOST_REPORT = 64 * 1024


class _Watcher:
    """A pytest plugin that stores the results of the tests, and reports to the grader whenever a test has ended."""

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
            os.write(ASKS, _TEST_ENDED)

    def report(self) -> bytes:
        """Return the report as JSON: the number of tests that were found, and the results of the last 50 tests."""
        return json.dumps({"collected": self.collected, "cases": self.cases[-50:]}).encode()


def _details(report: Any) -> dict[str, Any]:  # noqa: ANN401 - pytest's
    if report.outcome == "passed":
        return {}
    crash = getattr(report.longrepr, "reprcrash", None)
    if crash is None:
        return {"message": str(report.longrepr)[-1500:], "file": "", "line": 0}
    file, line = _last_of_tests(report.longrepr) or (str(crash.path), int(crash.lineno))
    return {"message": str(crash.message)[:1500], "file": file, "line": line}


def _last_of_tests(shown: Any) -> tuple[str, int] | None:  # noqa: ANN401 - pytest's
    """Return the last line of the traceback that is in a file below the current folder, but not in the node, or None.

    The exception may have been raised in a library that the test has called.
    """
    folder = Path.cwd()
    for entry in reversed(getattr(getattr(shown, "reprtraceback", None), "reprentries", [])):
        place = getattr(entry, "reprfileloc", None)
        if place is None:
            continue
        path = folder / str(place.path)
        if folder in path.parents and ("test" in path.name or path.parent.name != folder.name):
            return str(path), int(place.lineno)
    return None


def main() -> None:
    """Import everything, and run the tests once per request."""
    sys.path.pop(0)
    for name in _AHEAD:
        importlib.import_module(name)
    from _pytest.config import default_plugins

    for name in default_plugins:
        importlib.import_module(f"_pytest.{name}")
    for name, message in _TYPES_AHEAD:
        type(getattr(importlib.import_module(name), message)).__import_type_support__()
    order = json.loads(sys.stdin.buffer.readline())
    source = sys.stdin.buffer.read(order["size"])
    requests = socket.socket(fileno=order["requests"])
    entering.allow_inspection(allow=False)
    gc.freeze()
    os.write(1, READY)
    while _serve(requests, order, source):
        pass


def _serve(requests: socket.socket, order: dict[str, Any], source: bytes) -> bool:
    """Wait for one request, and then for the end of its run. Return False if there are no more requests."""
    request, passed, *_ = socket.recv_fds(requests, 1, 3)
    if request and os.fork() == 0:
        try:
            _supervise(order, source, *passed)
        finally:
            os._exit(0)
    for descriptor in passed:
        os.close(descriptor)
    if request:
        os.wait()
    return bool(request)


def _supervise(order: dict[str, Any], source: bytes, asks: int, answers: int, results: int) -> None:
    """Run the tests once, in a new cell or in a new folder, and send the result to the grader."""
    cell = _new_cell(order) if order["cell"] else None
    workspace = Path(order["workspace"])
    if cell is None:
        workspace = Path(tempfile.mkdtemp(dir=workspace))
        adopt_orphans()
    begun = time.monotonic()
    child = os.fork()
    if child == 0:
        _run_tests(order, source, workspace, asks, answers)
    result = socket.socket(fileno=results)
    entering.pass_descriptors(result, STARTED, [pidfd_open(child)])
    code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
    report = _report(workspace / "report.json")
    seconds = time.monotonic() - begun
    if cell is not None:
        cell.close()
    else:
        from grader.sandbox.descendants import kill_descendants  # a room does not contain this file

        kill_descendants(os.getpid())
        shutil.rmtree(workspace, ignore_errors=True)
    result.sendall(_HEADER.pack(code, seconds, len(report)) + report)


def _new_cell(order: dict[str, Any]) -> Holder:
    """Create a cell, and move this process into its namespaces, so that later forks are processes of the cell."""
    passed: tuple[int, ...] = ()
    if order["filter"] is not None:
        its_filter, writes = os.pipe()
        os.write(writes, base64.b64decode(order["filter"]))
        os.close(writes)
        os.dup2(its_filter, FILTER)
        os.close(its_filter)
        passed = (FILTER,)
    command: list[str] = order["cell"]
    option = command.index("--info-fd")
    cell = Holder(lambda info_fd: [*command[: option + 1], str(info_fd), *command[option + 2 :]], passed)
    holder = cell.await_ready()
    entering.enter(holder, cell=True)
    os.close(holder)
    return cell


def _run_tests(order: dict[str, Any], source: bytes, workspace: Path, asks: int, answers: int) -> NoReturn:
    """Run the tests as `colcon test` does, with pytest in the folder of the package, but stop at the first failure."""
    code: int = 1
    try:
        os.setsid()
        null = os.open(os.devnull, os.O_RDWR)
        entering.keep((null, null, null, asks, answers))
        entering.allow_inspection(allow=True)
        entering.end_with_parent()
        if order["cell"]:
            filter_ = base64.b64decode(order["filter"] or "")
            entering.confine(order["limits"], user=None, call_filter=filter_)
            entering.sacrifice()
        package = workspace / "src" / order["package"]
        Path(order["home"]).mkdir(parents=True, exist_ok=True)
        with tarfile.open(fileobj=io.BytesIO(source)) as tree:
            # A malicious member can do no harm in a cell, and the Python of Debian 12 has no extraction filters yet.
            tree.extraction_filter = lambda member, _path: member
            tree.extractall(workspace / "src")
        for name in [name for name in sys.modules if name.partition(".")[0] == "grader"]:
            del sys.modules[name]
        os.chdir(package)
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


if __name__ == "__main__":
    main()
