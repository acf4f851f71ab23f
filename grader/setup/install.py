"""The second half of the set-up: fill .venv from the lock file.

This module runs in .venv, even if no packages have been installed there yet.

`python -m grader.setup.install STAMP`: STAMP is the stamp of bootstrap.py as JSON. The stamp is written to .venv at the
end, with the duration of each stage (s), so an interrupted set-up has no stamp.
"""

from __future__ import annotations

import json
import os
import re
import site
import subprocess
import sys
import time
from importlib import metadata
from pathlib import Path
from typing import NamedTuple

from grader.common import terminal_text
from grader.common.interpreter import clean, interpreter
from grader.errors import MachineError
from grader.setup import installers, lock, setup_errors
from grader.setup.bootstrap import ROOT, STAMP, Stamp, replace, say, write_stamp
from grader.setup.uv import uv

_OPTIONS = ("--no-deps", "--require-hashes", "--no-build-isolation")
_PROGRESS = ("Downloading ", "Using cached ", "Building ", "Prepared ", "Installed ", "Bytecode compiled ")
_MOST_LINES = 40
_RETRIES = 2
"""The number of retries without a network after which the installer is stopped. pip would try for ten more seconds."""
_FIRST = frozenset({"uv", "setuptools"})
"""The packages that pip installs before uv installs the others: uv itself, and setuptools, which uv needs to build
empy."""
_OLDEST_NUMPY = (1, 25)
"""The oldest version of numpy that matplotlib, a dependency of the grader, supports."""
_NUMPY = Path(__file__).with_name("numpy.txt")
"""The last version of numpy 1, in pip's format. Extensions that were built for an older numpy 1 cannot use numpy 2."""
_PYTEST = Path(__file__).with_name("pytest.txt")
"""The last version of pytest 8, in pip's format. launch_testing of ROS 2 Jazzy has a plugin that pytest 9 refuses, so
`colcon test` with pytest 9 would run no test."""
_BOOTSTRAPPER, _BOOTSTRAPPED = "ros_wheels_bootstrapper", "_ROS_WHEELS_BOOTSTRAP_COMPLETE"
"""The module that each interpreter with the ROS wheels imports, and the variable that is set once the module has
run."""
_UNKNOWN = (
    "The packages could not be installed; the installer's messages are above. HTTPS_PROXY sets a proxy, and pip's "
    f"configuration sets a mirror; {setup_errors.AGAIN}."
)


class Ran(NamedTuple):
    """The result of running an installer: its exit code, its progress, and its other output."""

    code: int
    shown: list[str]
    said: str


def main(stamp: Stamp) -> int:
    """Install the stamp's parts and the project itself, and then write the stamp. Return the exit code."""
    try:
        seconds = {**stamp.seconds, **install(stamp.parts, sourced=stamp.ros != "wheels")}
    except MachineError as error:
        terminal_text.say(f"\n{error}")
        return setup_errors.MACHINE_BROKEN
    write_stamp(stamp._replace(seconds=seconds))
    say("Set up: " + ", ".join(f"{name} {value:.0f} s" for name, value in seconds.items()))
    return 0


def install(parts: list[str], *, sourced: bool) -> dict[str, float]:
    """Install from the lock file. Return the duration of the download and of the installation (s).

    Raises:
        MachineError: a package could not be installed.
    """
    text = lock.LOCK_FILE.read_text(encoding="utf-8")
    if sourced:
        parts = [part for part in parts if part != "ros"]
    without = lock.SOURCED_BRINGS | {"pytest"} if sourced else frozenset()

    begin = time.monotonic()
    say("Installing the installer (uv)")
    _pip(_write("setup", lock.select(text, ["setup"], only=_FIRST)))

    say("Installing " + ("what the grader needs" if sourced else "ROS 2 Jazzy and what the grader needs"))
    selected = lock.select(text, parts, without=without)
    if sourced:
        selected += _PYTEST.read_text(encoding="utf-8")
    if sourced and numpy_is_missing():
        say("The system has no numpy that matplotlib can use: .venv gets one, and the system is not changed")
        selected += _NUMPY.read_text(encoding="utf-8")
    rest = _write("rest", selected)
    downloading = _uv("-r", str(rest), *_OPTIONS, "--compile-bytecode")
    if downloading is None:
        # pip reads settings that uv does not read: mirrors, certificates and proxies in pip.conf.
        say("uv failed. Trying again with pip, which is slower")
        _pip(rest)
    project = ("--no-deps", "--no-build-isolation", "--editable", str(ROOT))
    if _uv(*project) is None:
        message = f"The course's own package could not be installed from {ROOT}; the installer's messages are above."
        raise MachineError(message)
    folder = Path(site.getsitepackages()[0])
    for path in folder.glob("_editable_impl_*.pth"):
        replace(path, ascii_only(path.read_text("utf-8")))
    start_fast(folder)
    total = time.monotonic() - begin
    return {"download": downloading or 0.0, "install": total - (downloading or 0.0)}


def start_fast(folder: Path) -> None:
    """Let each interpreter import the bootstrapper of the ROS wheels only if the bootstrapper has not run yet.

    The import takes 0.05 s each time, even if the variable is set and the bootstrapper does nothing.
    """
    path = folder / f"{_BOOTSTRAPPER}.pth"
    if path.exists():
        replace(path, f"import os; os.environ.get({_BOOTSTRAPPED!r}) or __import__({_BOOTSTRAPPER!r})\n")


def ascii_only(lines: str) -> str:
    """Return the lines of a .pth file in ASCII, without changing their meaning. Lines that are not ASCII must be paths.

    With LC_ALL=C, or with a locale that the machine does not have, Python 3.10 to 3.12 reads .pth files as ASCII. If
    the path of the course contained other characters, no interpreter of .venv would start.
    """
    return "".join(
        line if line.isascii() else f"import sys; sys.path.append({line.rstrip()!a})\n"
        for line in lines.splitlines(keepends=True)
    )


def numpy_is_missing() -> bool:
    """Return whether .venv needs its own numpy although a ROS 2 is sourced.

    The system may have no numpy, or one that is too old for matplotlib. A numpy inside the prefix of the sourced
    ROS 2 does not count: the grader's own processes do not search PYTHONPATH.
    """
    try:
        version = metadata.version("numpy")
    except metadata.PackageNotFoundError:
        return True
    return tuple(map(int, version.split(".")[:2])) < _OLDEST_NUMPY


def _pip(requirements: Path) -> None:
    """Run `pip install` with a file of requirements and hashes.

    Raises:
        MachineError: pip failed.
    """
    options = ("--disable-pip-version-check", "--no-input", "--retries", "2", "--progress-bar", "off", *_OPTIONS)
    env = {**installers.of_configuration(os.environ), **os.environ, "PIP_CONFIG_FILE": os.devnull}
    done = _run(*interpreter("-m", "pip", "install", *options, "-r", str(requirements), env=env))
    if done.code != 0:
        known = setup_errors.of_output(done.said, STAMP.parent)
        network = setup_errors.offline(done.said)
        if not known and not network:
            _repeat(done)
        known = known or (setup_errors.NO_NETWORK.format(network) if network else _UNKNOWN)
        raise MachineError(known + setup_errors.configured_indexes(done.said))


def _uv(*arguments: str) -> float | None:
    """Run `uv pip install`. Return the duration of the download (s), or None if uv failed and pip may succeed.

    Raises:
        MachineError: pip would fail for the same reason, such as a full disk.
    """
    command = uv("pip", "install", "--python", sys.executable, *arguments)
    if not _may_write(setup_errors.cache()):
        command.append("--no-cache")  # needed if the cache folder is not writable
    done = _run(command, clean(os.environ))
    if done.code == 0:
        return seconds_of(next((line for line in done.shown if line.startswith("Prepared ")), ""))
    known = setup_errors.of_output(done.said, STAMP.parent)
    if known:
        raise MachineError(known)
    _repeat(done)
    return None


def _may_write(folder: Path) -> bool:
    """Return whether files can be created in a folder, even if the folder does not exist yet."""
    return os.access(setup_errors.nearest(folder), os.W_OK)


def _run(command: list[str], env: dict[str, str]) -> Ran:
    """Run an installer and show its progress line by line. Stop the installer after two retries without a network.

    When pip and uv write to a pipe, they print a line at the start of each download, which makes slow downloads visible
    and keeps logs readable.
    """
    shown: list[str] = []
    rest: list[str] = []
    retried = 0
    with subprocess.Popen(
        command, env=env, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace"
    ) as process:
        for line in process.stdout or ():
            if line.strip().startswith(_PROGRESS):
                shown.append(line.strip().partition(" (from ")[0])
                print(f"  {shown[-1]}", flush=True)
                continue
            rest.append(line)
            retried += "Retrying" in line and setup_errors.offline(line) is not None
            if retried == _RETRIES:
                process.terminate()
    return Ran(process.returncode, shown, "".join(rest))


def _repeat(done: Ran) -> None:
    """Print the last messages of an installer."""
    print("".join(done.said.splitlines(keepends=True)[-_MOST_LINES:]), end="", flush=True)


def seconds_of(line: str) -> float:
    """Return the duration (s) at the end of a line of uv: `Prepared 9 packages in 1m 05s`, `... in 302ms`."""
    units = {"ms": 1e-3, "s": 1.0, "m": 60.0, "h": 3600.0}
    found: list[tuple[str, str]] = re.findall(r"(\d+(?:\.\d+)?)(ms|s|m|h)\b", line.rpartition(" in ")[2])
    return sum(float(number) * units[unit] for number, unit in found)


def _write(name: str, requirements: str) -> Path:
    path = STAMP.with_name(f"course-{name}.txt")
    path.write_text(requirements, encoding="utf-8")
    return path


if __name__ == "__main__":
    setup_errors.run_and_exit(lambda: main(Stamp(**json.loads(sys.argv[1]))))
