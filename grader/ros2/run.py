"""The verb `run`: start an executable of a package.

ros2 becomes that executable: signals, the terminal and the exit code are its own, and nothing stays behind.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import signal
import sys
from typing import TYPE_CHECKING, Any

from grader.ros import index
from grader.ros.failure import Ros2Error, did_you_mean

if TYPE_CHECKING:
    import argparse
    from pathlib import Path

_QUOTED = re.compile(r'#!"([^"]+)"(.*)')


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument("--prefix", help="a command to start it with: --prefix 'gdb -ex run --args'")
    parser.add_argument("package_name").completer = lambda **_: index.packages()  # type: ignore[attr-defined]
    parser.add_argument("executable_name").completer = _executables  # type: ignore[attr-defined]
    parser.add_argument("argv", nargs="...", help="arguments of the executable, as --ros-args -p name:=value")
    parser.set_defaults(verb=_run)


def _executables(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
    return [path.name for path in index.executables(parsed_args.package_name, "")]


def _run(args: argparse.Namespace) -> int:
    found = index.executables(args.package_name, f"Package '{args.package_name}' not found")
    path = next((path for path in found if path.name == args.executable_name), None)
    if path is None:
        names = [path.name for path in found]
        hint = did_you_mean(args.executable_name, names, "No executable found")
        have = ", ".join(names) if names else "none: its setup.py names them under entry_points"
        message = f"{hint}\nExecutables of {args.package_name}: {have}"
        raise Ros2Error(message)
    command = [*_words(args.prefix), *_program(path), *args.argv]
    program = shutil.which(command[0])
    if program is None:
        message = f"The prefix cannot be started: there is no command '{command[0]}'"
        raise Ros2Error(message)
    sys.stdout.flush()
    # Python ignores it, and would pass that on.
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    try:
        os.execv(program, command)
    except OSError as error:
        message = (
            f"{path} could not be started: {error.strerror}. Does its first line name an interpreter that is there?"
        )
        raise Ros2Error(message) from error


def _program(path: Path) -> list[str]:
    """How to start it. setuptools quotes an interpreter with a space in its path, which Linux does not understand."""
    try:
        with path.open("rb") as file:
            quoted = _QUOTED.match(file.readline(4096).decode("utf-8", "replace"))
    except OSError:
        quoted = None
    return [quoted[1], *quoted[2].split(), str(path)] if quoted else [str(path)]


def _words(prefix: str | None) -> list[str]:
    try:
        return shlex.split(prefix or "")
    except ValueError as error:
        message = f"The prefix cannot be read: {error}"
        raise Ros2Error(message) from error
