"""Call a function of the built package, or run one of its programs, without a simulator."""

from __future__ import annotations

import base64
import json
import os
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

from grader.common.interpreter import interpreter
from grader.common.temporary_folder import temporary_folder
from grader.errors import MachineError
from grader.ros import installation
from grader.sandbox import bubblewrap, process
from grader.sandbox.control_group import control_group
from grader.sandbox.limits import MIB, Limits, limited
from grader.sandbox.system_calls import call_filter
from grader.sandbox.user import cell_user

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

LIMITS = Limits(processes=200, cpu_s=60)
TIMEOUT_S = 60.0
MOST_OUTPUT = 2 * MIB
MOST_ERRORS = 64 * 1024
AHEAD = ("numpy", "rosbags.highlevel")
"""Modules that most programs import. They are imported once, before the calls. A function needs only the first."""
_SCRIPT = Path(__file__).with_name("cell_calls.py")
_READY = b"ready\n"


def make_calls(
    ros: installation.Ros,
    package: str,
    tree: bytes,
    calls: Sequence[Mapping[str, Any]],
    files: Mapping[str, bytes],
    *,
    function: str = "",
    executable: str = "",
    in_cell: bool,
) -> bytes:
    """Call the function, or run the executable, and return the output of the cell (see called.read_called).

    `tree` is the install tree of the package (a tar stream). `files` maps paths to the contents of files that are added
    to the program's current folder.

    Raises:
        MachineError: no call could be made, for example because the sandbox does not work.
    """
    with ExitStack() as stack:
        if in_cell:
            workspace, home = bubblewrap.WORKSPACE, bubblewrap.HOME
        else:
            workspace = stack.enter_context(temporary_folder())
            home = workspace / "home"
            home.mkdir()
        prefix = workspace / "install" / package
        env = installation.environment(ros, home=home, overlays=[prefix])
        order = {
            "calls": list(calls),
            "function": function,
            "script": str(prefix / "lib" / package / executable),
            "python_path": env["PYTHONPATH"].split(os.pathsep)[:1],
            "env": env,
            "install": str(workspace / "install"),
            "files": {path: base64.b64encode(data).decode() for path, data in files.items()},
            "ahead": AHEAD if executable else AHEAD[:1],
        }
        code = f"import os; os.chdir({str(workspace)!r})\n" + _SCRIPT.read_text("utf-8").partition('"""\n\n')[2]
        start = interpreter(
            "-c",
            code.replace("from __future__ import annotations\n", "", 1),
            env=env,
            searches=True,
            python=str(ros.python),
        )
        stdin = json.dumps(order).encode() + b"\n" + tree
        done = _run(stack, start.argv, env, ros, stdin, in_cell=in_cell)
    if not done.stdout.startswith(_READY):
        errors = done.stderr.decode("utf-8", "replace").strip().splitlines()[-1:] or ["no message"]
        message = f"The calls to the package failed: {errors[0]}. Check this machine with `grader doctor`."
        raise MachineError(message)
    return done.stdout[len(_READY) :]


def _run(
    stack: ExitStack, argv: Sequence[str], env: dict[str, str], ros: installation.Ros, stdin: bytes, *, in_cell: bool
) -> process.Finished:
    command = limited(argv, LIMITS)
    inherited: tuple[int, ...] = ()
    if in_cell:
        filter_fd = stack.enter_context(call_filter())
        group = stack.enter_context(control_group(LIMITS))
        user = stack.enter_context(cell_user())
        view = bubblewrap.ros_view(ros)
        command = group.joined(
            bubblewrap.lone_cell(argv, view, env=env, limits=LIMITS, user=user, filter_fd=filter_fd, first=True)
        )
        inherited = () if filter_fd is None else (filter_fd,)
    return process.run(
        command,
        stdin=stdin,
        env=env,
        timeout_s=TIMEOUT_S,
        most_stdout=MOST_OUTPUT,
        most_stderr=MOST_ERRORS,
        pass_fds=inherited,
        watch=LIMITS,
    )
