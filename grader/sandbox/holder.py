"""Open a sandbox room or cell for forks, and keep it open (entering.py)."""

from __future__ import annotations

import json
import os
import select
import signal
import subprocess
from contextlib import suppress
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING

from grader.common.linux_calls import pidfd_open, pidfd_send_signal

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


_PLAIN = {"PATH": "/usr/sbin:/usr/bin:/sbin:/bin"}
"""The environment of bubblewrap. A process in the room or cell may be able to read this environment in /proc/1/environ,
even if the programs that bubblewrap starts have a different one."""
_ENDS_S = 5.0


class HolderError(Exception):
    """bubblewrap could not create the room or cell. The message is the output of bubblewrap, or a system error."""


class Holder:
    """The processes of bubblewrap and of entering.HOLDER. The room or cell exists until they exit."""

    def __init__(self, command: Callable[[int], Sequence[str]], pass_fds: Sequence[int] = ()) -> None:
        """Start bubblewrap. `command(info_fd)` returns a command line of bubblewrap that runs entering.HOLDER."""
        self._info, info = os.pipe()
        self._first: int | None = None
        self._changing = Lock()
        try:
            pipe = subprocess.PIPE
            self._process = subprocess.Popen(
                command(info),
                stdin=pipe,
                stdout=pipe,
                stderr=pipe,
                bufsize=0,
                env=_PLAIN,
                pass_fds=(info, *pass_fds),
                start_new_session=True,
            )
        except BaseException:
            os.close(self._info)
            raise
        finally:
            os.close(info)

    @property
    def pid(self) -> int:
        """The process id of bubblewrap, which is the ancestor of all orphans in the room or cell."""
        return self._process.pid

    def await_ready(self) -> int:
        """Wait until bubblewrap has created the room or cell. Return a descriptor of HOLDER, for entering.enter.

        Raises:
            HolderError: bubblewrap failed.
        """
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        assert self._process.stderr is not None
        problem: Exception | None = None
        with open(self._info, "rb") as about:  # noqa: PTH123 - a descriptor
            try:
                self._process.stdin.write(b"?")
                if self._process.stdout.read(1):  # HOLDER is running, so all namespaces and mounts exist
                    first = int(json.loads(about.read())["child-pid"])
                    self._first = pidfd_open(first)
                    children = Path(f"/proc/{first}/task/{first}/children").read_text("ascii")
                    return pidfd_open(int(children.split()[0]) if children else first)
            except (OSError, ValueError, IndexError) as error:
                problem = error
        self.kill()
        output = self._process.stderr.read().decode("utf-8", "replace").strip()
        raise HolderError(output or str(problem or "bubblewrap exited without a message")) from problem

    def kill(self) -> None:
        """Kill all processes of the room or cell. Any thread may call this method."""
        # Kill the whole process group, because a child of bubblewrap may outlive it while bubblewrap is starting.
        if self._process.returncode is None:
            with suppress(ProcessLookupError):
                os.killpg(self._process.pid, signal.SIGKILL)
        # The first process of a cell belongs to the user of the cell. Student code can change its memory, so that it
        # does not exit together with its parent. All other processes of the cell end with it: pid_namespaces(7).
        with self._changing, suppress(ProcessLookupError):
            if self._first is not None:
                pidfd_send_signal(self._first, signal.SIGKILL)

    def close(self) -> None:
        """Kill all processes of the room or cell, and wait until they have exited."""
        self.kill()
        for pipe in (self._process.stdin, self._process.stdout, self._process.stderr):
            assert pipe is not None
            pipe.close()
        self._process.wait()
        with self._changing:
            first, self._first = self._first, None
        if first is not None:
            ended = select.poll()
            ended.register(first, select.POLLIN)
            ended.poll(_ENDS_S * 1000.0)
            os.close(first)
