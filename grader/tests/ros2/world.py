"""A separate domain for tests of commands. Processes are started and commands are typed in bash, as users do."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import threading
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import IO, TYPE_CHECKING

from grader.ros import installation, underlay
from grader.tests.both_worlds import PATH, REAL_ROS2, SOURCED_ENV
from grader.tests.domains import own_domain, separate_domain
from grader.tests.waiting import HANG_S, only_child

if TYPE_CHECKING:
    from collections.abc import Iterator

SOLUTION = Path(__file__).parents[3] / "solutions/03-circle-publisher/my_robot_controller"


@dataclass(frozen=True)
class Done:
    """A command that has ended."""

    stdout: str
    stderr: str
    code: int


@dataclass
class Running:
    """A process with the lines that it has written so far. Standard output and standard error are merged."""

    process: subprocess.Popen[str]
    lines: list[str] = field(default_factory=list)
    _news: threading.Condition = field(default_factory=threading.Condition)
    _ended: threading.Event = field(default_factory=threading.Event)

    def read(self, stream: IO[str]) -> None:
        """Collect the lines of the output in a separate thread."""
        for line in stream:
            with self._news:
                self.lines.append(line.rstrip("\n"))
                self._news.notify_all()
        self._ended.set()

    @property
    def program(self) -> int:
        """Return the id of the process that `ros2 run` has started."""
        return only_child(self.process.pid)

    def wait_for(self, text: str, times: int = 1) -> None:
        """Wait until at least this number of lines contain `text`."""
        with self._news:
            there = self._news.wait_for(lambda: sum(text in line for line in self.lines) >= times, HANG_S)
        assert there, f"no line contains '{text}':\n" + "\n".join(self.lines)

    def stop(self, number: int = signal.SIGINT) -> int:
        """Send a signal to the process group, as a terminal does. Return the exit code after all lines are read."""
        if self.process.poll() is None:
            os.killpg(self.process.pid, number)
        try:
            code = self.process.wait(HANG_S)
        except subprocess.TimeoutExpired:
            os.killpg(self.process.pid, signal.SIGKILL)
            raise
        assert self._ended.wait(HANG_S), "a process that it started is still running"
        return code


def children(pid: int) -> list[int]:
    """Return the ids of the running child processes of a process."""
    return [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


@dataclass
class World:
    """A home folder, an environment with ROS 2, and a separate domain."""

    home: Path
    env: dict[str, str]
    running: list[Running] = field(default_factory=list)

    def run(self, command: str, *, stdin: str = "", **env: str) -> Done:
        """Type a command and wait until it ends."""
        done = subprocess.run(
            ["bash", "-c", command],
            env={**self.env, **env},
            cwd=self.home,
            input=stdin,
            capture_output=True,
            text=True,
            timeout=HANG_S,
            check=False,
        )
        return Done(done.stdout, done.stderr, done.returncode)

    def start(self, command: str, ready: str | None = None, **env: str) -> Running:
        """Start a command in a separate process group, and wait for a line that contains `ready`."""
        process = subprocess.Popen(
            ["bash", "-c", f"exec {command}"],
            env={**self.env, **env},
            cwd=self.home,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        assert process.stdout is not None
        running = Running(process)
        threading.Thread(target=running.read, args=[process.stdout], daemon=True).start()
        self.running.append(running)
        if ready is not None:
            running.wait_for(ready)
        return running

    def turtlesim(self) -> Running:
        """Start turtlesim as the tutorial does."""
        return self.start("ros2 run turtlesim turtlesim_node", "Spawning turtle")

    def draw_circle(self, install: Path) -> Running:
        """Start the tutorial's node from a built workspace."""
        return self.start(
            f"bash -c 'source {install}/setup.bash && exec ros2 run my_robot_controller draw_circle'", "Draw"
        )

    def end(self) -> None:
        """Stop all processes that were started, even if one of them does not end."""
        with ExitStack() as stack:
            for running in self.running:
                stack.callback(running.stop)
        if REAL_ROS2:
            self.run("ros2 daemon stop")


_FUNCTIONS = (
    {"BASH_FUNC_rqt_graph%%": f'() {{ {shlex.quote(str(Path(sys.prefix, "bin/rqt_graph")))} "$@"; }}'}
    if SOURCED_ENV
    else {}
)
"""The shell functions that `source <(grader env)` defines if a ROS 2 is sourced (grader/ros/shell.py)."""


def environment(home: Path, domain: int | None = None) -> dict[str, str]:
    """Return the environment after `source <(grader env)`, with a separate domain."""
    ros = underlay.with_turtlesim(installation.find_ros())
    own = own_domain() if domain is None else domain
    ours = str(Path(sys.executable).parent)
    user = {
        **SOURCED_ENV,
        **_FUNCTIONS,
        "HOME": str(home),
        # Tests that need the daemon start it.
        "GRADER_ROS2_DAEMON": "0",
        "PATH": f"{PATH}:{ours}" if SOURCED_ENV else f"{ours}:{PATH}",
        # The window of the real turtlesim then needs no screen.
        "QT_QPA_PLATFORM": "offscreen",
        "LANG": "C.UTF-8",
        "TERM": "dumb",
    }
    return installation.users_environment(ros, {**user, "LOGNAME": "root"}, own)


def world(home: Path) -> Iterator[World]:
    """Yield a folder with an environment and processes, as a value for a fixture.

    All processes end when the tests that use the yielded object have ended.
    """
    home.mkdir(parents=True, exist_ok=True)
    with separate_domain() as domain:
        made = World(home, environment(home, domain))
        try:
            yield made
        finally:
            made.end()


def build(home: Path, env: dict[str, str]) -> Path:
    """Build the solution's package in a workspace. Return its install folder."""
    workspace = home / "ros2_ws"
    shutil.copytree(SOLUTION, workspace / "src/my_robot_controller")
    subprocess.run(["colcon", "build"], cwd=workspace, env=env, check=True, capture_output=True, timeout=HANG_S)
    return workspace / "install"


_GOLDEN = Path(__file__).parents[1] / "golden/ros2"


@dataclass(frozen=True)
class Golden:
    """A recording of the real `ros2`: a command, its output, and its exit code."""

    command: str
    stdout: str
    stderr: str
    code: int


def golden(name: str) -> Golden:
    """Return a recording."""
    text = (_GOLDEN / f"{name}.txt").read_text("utf-8")
    match = re.fullmatch(r"\$ (.*?)\n(.*)\[exit (\d+)\](?: \(after SIGINT at \d+s\))?\n", text, re.DOTALL)
    assert match, name
    errors = _GOLDEN / f"{name}.stderr.txt"
    stderr = errors.read_text("utf-8").partition("(stderr)\n")[2] if errors.exists() else ""
    return Golden(match[1], match[2], stderr, int(match[3]))


def all_golden() -> set[str]:
    """Return the names of all recordings."""
    return {path.name.partition(".")[0] for path in _GOLDEN.iterdir()}
