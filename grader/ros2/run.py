"""The verb `run`: start an executable of a package, and return its exit code."""

from __future__ import annotations

import re
import shlex
import shutil
import sys
from typing import TYPE_CHECKING, Any

from grader.common.noexec import noexec_folder, noexec_sentence
from grader.ros import index
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros2 import unsourced
from grader.ros2.completion import completes, packages

if TYPE_CHECKING:
    import argparse
    from pathlib import Path


_QUOTED = re.compile(r'#!"([^"]+)"(.*)')
_UNQUOTED = re.compile(r"#!(/[^\s\"]+)(.*)")
_LONGEST = 255
"""The number of bytes of a script's first line that the kernel reads (BINPRM_BUF_SIZE of Linux, minus the last
byte)."""


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument("--prefix", help="a command that starts the executable, such as --prefix 'gdb -ex run --args'")
    completes(parser.add_argument("package_name", help="name of the package, such as turtlesim"), packages)
    completes(parser.add_argument("executable_name", help="name of the executable"), _executables)
    parser.add_argument("argv", nargs="...", help="arguments of the executable, such as --ros-args -p name:=value")


def _executables(parsed_args: argparse.Namespace, **_: Any) -> list[str]:  # noqa: ANN401
    return [path.name for path in index.executables(parsed_args.package_name, "")]


def run(args: argparse.Namespace) -> int:
    """Start the executable and wait until it exits.

    Return the exit code, which is negative if a signal terminated the program.

    Raises:
        Ros2Error: the package, the executable or the command of the prefix does not exist or cannot be started, or
            several executables of the package have this name.
    """
    from grader.ros2.child import run_child

    prefix = _words(args.prefix)
    command = [*prefix, *_program(_path(args)), *args.argv]
    if prefix and shutil.which(prefix[0]) is None:
        message = f"The prefix cannot be started: the command '{prefix[0]}' was not found"
        raise Ros2Error(message)
    sys.stdout.flush()
    return run_child(command)


def _path(args: argparse.Namespace) -> Path:
    unknown = f"Package '{args.package_name}' not found"
    unsourced.find(args.package_name, unknown)
    all_of_them = index.executables(args.package_name, unknown)
    found = [path for path in all_of_them if path.name == args.executable_name]
    if len(found) > 1:
        message = "\n".join(["Multiple executables found:", *(f"- {path}" for path in found)])
        raise Ros2Error(message)
    if not found:
        folder = index.packages()[args.package_name] / "lib" / args.package_name
        mounted = noexec_folder(folder)
        if mounted and (folder / args.executable_name).is_file():
            instead = (
                "move your workspace to another file system, delete its folders build, install and log, and build again"
            )
            raise Ros2Error(noexec_sentence(mounted, instead))
        names = [path.name for path in all_of_them]
        hint = did_you_mean(args.executable_name, names, "No executable found")
        have = ", ".join(names) or _why_none(folder)
        message = f"{hint}\nExecutables of {args.package_name}: {have}"
        raise Ros2Error(message)
    return found[0]


def _why_none(folder: Path) -> str:
    """Return why there are no executables in `folder`, the folder lib/PACKAGE of a package."""
    prefix = folder.parent.parent
    if prefix.name == folder.name:  # a workspace of colcon, where no other package is installed in this prefix
        others = (each for each in sorted(folder.parent.glob("*")) if not each.name.startswith("python"))
        other = next((each.name for each in others if index.executables_in(each)), None)
        if other:
            return f"none in lib/{folder.name}, but in lib/{other}; install_scripts in setup.cfg names this folder"
    return "none; entry_points in setup.py defines those of a Python package"


def _program(path: Path) -> list[str]:
    """Return the command that starts a file, with the interpreter in front if the kernel cannot start the script.

    setuptools quotes interpreter paths that contain spaces, but Linux accepts neither quoted nor very long paths in the
    first line of a script.
    """
    try:
        with path.open("rb") as file:
            line = file.readline(4096)
    except OSError:
        line = b""
    form = _UNQUOTED if len(line) > _LONGEST else _QUOTED
    found = form.match(line.decode("utf-8", "replace"))
    return [found[1], *found[2].split(), str(path)] if found else [str(path)]


def _words(prefix: str | None) -> list[str]:
    try:
        return shlex.split(prefix or "")
    except ValueError as error:
        message = f"The prefix cannot be read: {error}"
        raise Ros2Error(message) from error
