"""The processes of the workers are forks of one server, share the fork servers, and end with their owner."""

from __future__ import annotations

import os
import subprocess
from contextlib import ExitStack, closing, suppress
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.classroom import worker
from grader.classroom.task import Task
from grader.classroom.worker import Worker
from grader.common.interpreter import interpreter
from grader.exercise.private_checks import Sources
from grader.sandbox import bubblewrap
from grader.tests.waiting import HANG_S, until
from grader.trial.fork_client import ForkServer

if TYPE_CHECKING:
    from collections.abc import Iterator

OUTDATED = Task("ada", "ada", Sources("03-circle-publisher", b""), {}, grader="0.0.1 0123456789abcdef")


@pytest.fixture(autouse=True)
def server(monkeypatch: pytest.MonkeyPatch) -> Iterator[ForkServer]:
    """Give each test its own worker server."""
    own = ForkServer(worker._started)
    monkeypatch.setattr(worker, "_server", lambda: own)
    with closing(own):
        yield own


def refuses(one: Worker) -> bool:
    """Return whether the worker answers that the task comes from another version of the grader."""
    one.send(OUTDATED)
    answer = one.receive()
    return answer is not None and answer[0] == "fails" and "a different version of the grader" in str(answer[1])


def below(pid: int) -> dict[int, str]:
    """Return the command line of each process below this process. Processes that are ending may be left out."""
    found: dict[int, str] = {}
    with suppress(OSError):  # the process has ended
        for child in map(int, Path(f"/proc/{pid}/task/{pid}/children").read_text().split()):
            with suppress(OSError):
                found[child] = Path(f"/proc/{child}/cmdline").read_text().replace("\0", " ")
                found |= below(child)
    return found


@pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")
def test_workers_share_the_fork_servers_and_leave_them_running(server: ForkServer) -> None:
    with ExitStack() as stack:
        several = [stack.enter_context(closing(Worker())) for _ in range(3)]
        assert all(map(refuses, several))
        assert server._process is not None
        processes = below(server._process.pid)
        servers = [pid for pid, command in processes.items() if "grader.trial.fork_server" in command]
        assert len(servers) == 2
        workers = {pid for one in several if (pid := one.process.await_started()) is not None}
        assert len(workers) == 3
        assert workers < set(processes)
        several[0].close()
        assert refuses(several[1])
        # While a process ends, the kernel may leave one of its siblings out of the list (proc(5)).
        process = server._process
        until(lambda: set(servers) < set(below(process.pid)))


def test_workers_do_not_share_random_numbers(server: ForkServer, tmp_path: Path) -> None:
    """Otherwise, two workers would choose the same user or the same domain."""
    code = (
        "import sys; from grader.classroom import worker\n"
        "import random; random.random()\n"
        f"worker._grade_tasks = lambda _: open({str(tmp_path / 'drawn')!r}, 'a').write(f'{{random.random()}}\\n')\n"
        "worker.main(int(sys.argv[1]))\n"
    )
    server._start = lambda descriptor: started(code, descriptor)
    for _ in range(2):
        with closing(Worker()) as one:
            one.process.wait(HANG_S)
    assert len(set((tmp_path / "drawn").read_text().split())) == 2


def started(code: str, descriptor: int) -> subprocess.Popen[bytes]:
    start = interpreter("-c", code, str(descriptor))
    return subprocess.Popen(start.argv, env=start.env, pass_fds=[descriptor], start_new_session=True)


def test_a_worker_that_cannot_import_its_modules_says_why(server: ForkServer) -> None:
    code = (
        "import sys; from grader.classroom import worker\n"
        "def fail(): raise ImportError('No module named numpy')\n"
        "worker._import_all = fail\n"
        "worker.main(int(sys.argv[1]))\n"
    )
    server._start = lambda descriptor: started(code, descriptor)
    with closing(Worker()) as one:
        one.send(OUTDATED)
        assert one.receive() is None
        assert "it ended with exit code 1" in one.last_words()
        assert "No module named numpy" in one.last_words()


def test_the_server_ends_with_its_owner_and_its_workers(server: ForkServer) -> None:
    with closing(Worker()) as one:
        assert refuses(one)
        assert server._process is not None
        everybody = [server._process.pid, *below(server._process.pid)]
        assert server._requests is not None
        server._requests.close()  # as if the owner had exited
        server._process.wait(HANG_S)
    until(lambda: not any(map(runs, everybody)))


def runs(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_only_the_workers_have_one_memory_pool_and_the_processes_of_a_trial_have_the_usual_environment(
    server: ForkServer,
) -> None:
    with closing(Worker()) as one:
        assert refuses(one)
        assert server._process is not None
        commands = {server._process.pid: "grader.classroom.worker", **below(server._process.pid)}
        workers = {pid for pid, command in commands.items() if "grader.classroom.worker" in command}
        limited = {
            pid for pid in commands if b"MALLOC_ARENA_MAX=1" in Path(f"/proc/{pid}/environ").read_bytes().split(b"\0")
        }
    assert limited == workers
    assert len(workers) > 1
    assert workers < commands.keys() or not bubblewrap.usable()


def test_a_server_that_was_killed_is_started_again(server: ForkServer) -> None:
    with closing(Worker()) as one:
        assert refuses(one)
        assert server._process is not None
        os.kill(server._process.pid, 9)
        server._process.wait(HANG_S)
    with closing(Worker()) as another:
        assert refuses(another)
