"""`python -m grader.open.node_in_cell SETTINGS`: build a package and run one of its programs in the sandbox.

The program can reach the turtlesim of this machine (linked_cell.py). The program is stopped by Ctrl-C, SIGTERM or
SIGHUP, when it exceeds a limit of its cell, or when standard input closes because the process that started node_in_cell
has exited.
"""

from __future__ import annotations

import json
import os
import signal
import sys
import time
from contextlib import suppress
from pathlib import Path
from selectors import EVENT_READ
from typing import TYPE_CHECKING

from grader.colcon.runner import build
from grader.common.how_ended import program_ended
from grader.errors import GraderError, UsageError
from grader.learner.run_node import no_executable, no_package, program_of
from grader.open.linked_cell import environment, linked_cell
from grader.ros import installation, shell, underlay
from grader.sandbox import bubblewrap
from grader.submission.package import open_submission

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FrameType

    from grader.colcon.runner import Built
    from grader.learner.run_node import Program
    from grader.open.linked_cell import LinkedCell
    from grader.ros.installation import Ros

STOP_S = 4.0
"""The maximum time for the program to exit after Ctrl-C (s). After this time, the program is killed."""
_LOOK_S = 0.2
_CHUNK = 65536


def run(program: Program) -> int:
    """Build the package, and run the program until Ctrl-C or until it exits. Return the exit code.

    The exit code is 0 if the program was stopped or exited without an error, and 1 if it failed or exceeded a limit, or
    if the package could not be built.

    Raises:
        GraderError: the package cannot be read or does not contain the program, or the machine cannot build or run it.
    """
    env = shell.users_environment(None, _tell)
    ros = underlay.with_turtlesim(installation.find_ros(), _tell)
    _tell(f"Building {program.package}")
    built = build(open_submission(program.folder), ros, in_cell=True, tell=lambda _: None)
    if built.build.exit_code != 0 or built.build.package != program.package:
        print(built.build.log.rstrip())
        failed = "The package could not be built. See the messages of colcon above."
        print(f"\n{failed if built.build.exit_code else no_package(program)}")
        return 1
    if program.executable not in built.build.executables:
        raise UsageError(no_executable(program))
    domain = int(env["ROS_DOMAIN_ID"])
    with linked_cell(ros, domain) as cell:
        _start(cell, program, built, ros, domain)
        print(f"{program.executable} is running in a sandbox.\n", flush=True)
        return _until_it_ends(cell, program)


def _start(cell: LinkedCell, program: Program, built: Built, ros: Ros, domain: int) -> None:
    """Send the install tree, and the data about the node to run, to trial/launcher.py."""
    prefix = bubblewrap.WORKSPACE / "install" / program.package
    env = environment(ros, domain, [prefix])
    order = {
        "script": str(prefix / "lib" / program.package / program.executable),
        "ros_arguments": [],
        "python_path": env["PYTHONPATH"].split(os.pathsep)[:1],
        "env": env,
        "install": str(prefix.parent),
    }
    assert cell.process.stdin is not None
    with suppress(BrokenPipeError):
        cell.process.stdin.write(json.dumps(order).encode() + b"\n" + built.tree)
        cell.process.stdin.close()


def _until_it_ends(cell: LinkedCell, program: Program) -> int:
    asked_s: list[float] = []

    def stop(_number: int = 0, _frame: FrameType | None = None) -> None:
        asked_s.append(time.monotonic())
        cell.interrupt()

    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, stop)
    output = _Output(cell, program)
    cell.selector.register(output.pipe, EVENT_READ, output.pass_on)
    cell.selector.register(sys.stdin, EVENT_READ, lambda: _read_order(cell, stop))
    while not output.ended:
        for key, _ in cell.selector.select(_LOOK_S):
            key.data()
        if asked_s and time.monotonic() - asked_s[0] > STOP_S:
            print(f"\n{program.executable} did not end after Ctrl-C, so it was killed.")
            cell.kill()
            return 0
    code = cell.process.wait()
    if asked_s:
        return 0
    if cell.out_of:
        print(f"\n{program.executable} was stopped, because it exceeded its limit on {cell.out_of}.")
        return 1
    print(program_ended(program.executable, code))
    return 0 if code == 0 else 1


def _read_order(cell: LinkedCell, stop: Callable[[], None]) -> None:
    """Call `stop` if standard input has been closed. Standard input never contains data."""
    if not os.read(sys.stdin.fileno(), _CHUNK):
        cell.selector.unregister(sys.stdin)
        stop()


class _Output:
    """Prints the output of the node, with the paths of the learner's files instead of those of their copies."""

    def __init__(self, cell: LinkedCell, program: Program) -> None:
        assert cell.process.stdout is not None
        self.pipe = cell.process.stdout
        self.ended = False
        self._rest = b""
        version = f"python{sys.version_info.major}.{sys.version_info.minor}"
        copies = bubblewrap.WORKSPACE / "install" / program.package / "lib" / version / "site-packages"
        self._copies, self._own = f"{copies}/".encode(), f"{program.folder}/".encode()

    def pass_on(self) -> None:
        """Read the available data, and print the complete lines. At the end of the output, also print the last line.

        A very long line is printed in parts.
        """
        chunk = os.read(self.pipe.fileno(), _CHUNK)
        self.ended = not chunk
        whole, newline, rest = (self._rest + chunk).rpartition(b"\n")
        if self.ended or len(rest) > _CHUNK:
            whole, newline, rest = whole + newline + rest, b"", b""
        self._rest = rest
        sys.stdout.buffer.write((whole + newline).replace(self._copies, self._own))
        sys.stdout.buffer.flush()


def _tell(text: str) -> None:
    print(f"{text} ...", flush=True)


def main() -> None:
    """Run the program that is specified in the settings, and exit."""
    settings = json.loads(sys.argv[1])
    workspace = Path(settings["workspace"]) if settings["workspace"] else None
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        code = run(program_of(settings["step"], settings["executable"], workspace))
    except GraderError as error:
        print(f"\n{error}")
        code = error.exit_code
    sys.stdout.flush()
    sys.exit(code)


if __name__ == "__main__":
    main()
