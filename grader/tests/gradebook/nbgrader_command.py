"""Run nbgrader commands as forks of a process that has imported nbgrader, since the import takes two seconds.

`python -m grader.tests.gradebook.nbgrader_command` reads commands until standard input is closed.
"""

from __future__ import annotations

import functools
import json
import os
import signal
import subprocess
import sys
import tempfile
import traceback
from typing import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from pathlib import Path

TIMEOUT_S = 1800


def nbgrader(*command: str, cwd: Path, **env: str) -> tuple[int, str]:
    """Run `nbgrader` with these arguments. Return the exit code and both output streams of the command."""
    server = _server()
    assert server.stdin is not None
    assert server.stdout is not None
    with tempfile.NamedTemporaryFile() as output:
        order = {"command": command, "cwd": str(cwd), "env": {**os.environ, **env}, "output": output.name}
        server.stdin.write(json.dumps(order) + "\n")
        server.stdin.flush()
        code = int(server.stdout.readline())
        return code, output.read().decode("utf-8", "replace")


@functools.cache
def _server() -> subprocess.Popen[str]:
    """Return a server. When this process ends, the server's standard input is closed, and the server exits."""
    pipe = subprocess.PIPE
    argv = [sys.executable, "-W", "ignore", "-m", "grader.tests.gradebook.nbgrader_command"]
    return subprocess.Popen(argv, stdin=pipe, stdout=pipe, text=True)


def main() -> None:
    """Run each command from standard input in a fork, and print the exit code of the command."""
    from nbgrader.apps import nbgraderapp  # noqa: F401 - its import is what takes long

    for line in sys.stdin:
        child = os.fork()
        if child == 0:
            _become(json.loads(line))
        print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)


def _become(order: dict[str, Any]) -> NoReturn:
    code = 1
    try:
        signal.alarm(TIMEOUT_S)
        os.chdir(order["cwd"])
        os.environ.clear()
        os.environ.update(order["env"])
        output = os.open(order["output"], os.O_WRONLY | os.O_APPEND)
        os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
        os.dup2(output, 1)
        os.dup2(output, 2)
        sys.argv = ["nbgrader", *order["command"]]
        code = _run()
    except BaseException:
        traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


def _run() -> int:
    from nbgrader.apps.nbgraderapp import main

    try:
        main()
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else int(end.code is not None)
    return 0


if __name__ == "__main__":
    main()
