"""The first half of the set-up: check the machine and create .venv. The second half is grader.setup.install.

    python3 -m grader.setup.bootstrap (learner | cluster | notebooks | docs | tests) [--python PYTHON]

Like machine.py, this module runs under any Python from 3.6 on, before anything is installed, so it uses only the syntax
of Python 3.6.
"""

import argparse
import fcntl
import hashlib
import json
import os
import platform
import shlex
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import Dict, List, NamedTuple, Optional, Sequence, TextIO, Tuple

from grader.common import interpreter, package_managers, terminal_text
from grader.common.package_managers import Need
from grader.common.readable_by_all import make_readable
from grader.setup import installers, machine, setup_errors
from grader.setup.compiled_modules import remove_incomplete
from grader.setup.place import place_problem
from grader.setup.provide import provide
from grader.setup.setup_errors import MACHINE_BROKEN

ROOT = Path(__file__).resolve().parents[2]
VENV = ROOT / ".venv"
PYTHON = VENV / "bin/python3"
STAMP = VENV / "course-setup.json"
WHEELS = "wheels"
PARTS = {
    "learner": ["setup", "grader", "ros"],
    "cluster": ["setup", "grader", "ros", "cluster"],
    "notebooks": ["setup", "grader", "ros", "notebooks"],
    "docs": ["setup", "grader", "docs"],
    "tests": ["setup", "grader", "ros", "cluster", "notebooks", "docs", "tests"],
}

COPIED = (
    *("grader/setup/commands", "grader/setup/prefix", "grader/gradebook/jupyter_server.json"),
    *(f"grader/ros/{name}" for name in ("local_setup.sh", "local_setup.bash", "local_setup.zsh")),
    *("grader/ros/setup.bash", "grader/ros/setup.zsh"),
)
"""The files and folders of the course that pyproject.toml copies into .venv."""


class Stamp(NamedTuple):
    """The properties with which .venv was created. The stamp is written last, so an interrupted set-up has no stamp."""

    root: str
    ros: str
    """The prefix of the sourced ROS 2, or WHEELS if the wheels are installed."""
    python: str
    version: List[int]
    digest: str
    """The hash that the function `digest` returned."""
    parts: List[str]
    seconds: Dict[str, float]


def read_stamp(path: Path = STAMP) -> Optional[Stamp]:
    """Return the stamp of a finished set-up, or None if there is no stamp with these fields."""
    try:
        return Stamp(**json.loads(path.read_text()))
    except (OSError, ValueError, TypeError):
        return None


def write_stamp(stamp: Stamp, path: Path = STAMP) -> None:
    """Write the stamp in one step."""
    replace(path, json.dumps(stamp._asdict(), indent=1))


def replace(path: Path, text: str) -> None:
    """Replace a file by ASCII text in one step, so that no program reads an incomplete file.

    The old file itself is not changed, because it may be a hard link to a file in the installer's cache.
    """
    unfinished = path.with_suffix(".new")
    unfinished.write_text(text, "ascii")
    unfinished.replace(path)


def digest() -> str:
    """Return a hash of the files that pin versions, of pyproject.toml, and of the files that are copied into .venv."""
    whole = hashlib.sha256()
    for name in ("requirements.lock", "grader/setup/numpy.txt", "grader/setup/pytest.txt", "pyproject.toml", *COPIED):
        place = ROOT / name
        for path in sorted(place.rglob("*")) if place.is_dir() else [place]:
            if path.is_file():
                whole.update(path.read_bytes())
    return whole.hexdigest()


def outdated(error: BaseException) -> Optional[str]:
    """Return a sentence that says that the course has changed since its set-up, if `error` is a failed import.

    Return None for any other error, if there is no stamp, or if nothing has changed.
    """
    stamp = read_stamp()
    if not isinstance(error, ImportError) or stamp is None or stamp.digest == digest():
        return None
    again = f"cd {shlex.quote(str(ROOT))} && make demo"
    return f"the course has changed since its set-up ({error}). Set it up again: {again}"


def stands(stamp: Stamp, ros: Optional[machine.SourcedRos], wanted: Optional[machine.Python]) -> bool:
    """Return whether .venv is still usable: at the same path, for this ROS 2, and with the Python that created it.

    If a Python was requested (`wanted`), it must be this Python.
    """
    now = machine.probe(str(PYTHON))
    same = now is not None and (now.path, list(now.version)) == (stamp.python, stamp.version)
    if not same or stamp.root != str(ROOT) or (wanted is not None and wanted.path != stamp.python):
        return False
    if ros is None or now is None:
        return stamp.ros == WHEELS
    return os.path.realpath(stamp.ros) == os.path.realpath(ros.prefix) and not machine.for_ros(now, ros).lacks


def finds_course() -> bool:
    """Return whether .venv can import the course: the .pth file with the course's path exists and is not empty."""
    files = STAMP.parent.glob("lib/python*/site-packages/_editable_impl_*.pth")
    return any(file.stat().st_size for file in files)


def say(text: str) -> None:
    """Print a heading of the set-up, in bold on a terminal."""
    terminal_text.say(text, sys.stdout, style=terminal_text.BOLD)


def look(
    ros: Optional[machine.SourcedRos], wanted: Optional[machine.Python], parts: Sequence[str], *, made: bool
) -> Tuple[Optional[machine.Python], List[Need]]:
    """Return the Python for a new .venv, and the missing programs.

    The Python is None if .venv is still usable (`made`), or if no Python is suitable.
    """
    path = os.environ.get("PATH", "")
    tools = machine.missing_tools(path, ros)
    if "tests" in parts:
        # Many tests need the sandbox, so it is required here.
        tools = [need._replace(lost="") for need in tools] + machine.missing_of_tests(path)
    if made:
        return None, tools
    version = ros.python if ros else None
    pythons = iter([wanted]) if wanted else machine.find_pythons(path)
    refused = []
    if ros:
        found = [machine.for_ros(python, ros) for python in pythons]
        refused = [python for python in found if python.lacks]
        pythons = iter(found)
    python = machine.choose_python(pythons, root=os.getuid() == 0, wanted=version)
    manager = package_managers.find_manager(path)
    newer = manager.newer if manager and Path("/usr/bin/python3").exists() else ""
    return python, machine.missing_of_python(python, version, newer, refused) + tools


def report_missing(needs: Sequence[Need], why: str) -> bool:
    """Print the missing programs, and the reason `why` they were not installed. Return True if the set-up must stop."""
    root = os.getuid() == 0
    manager = package_managers.find_manager(os.environ.get("PATH", ""))
    if not all(need.lost for need in needs):
        terminal_text.say(machine.lack_message(needs, manager, root=root, why=why))
        return True
    for need in needs:
        reason = f" It was not installed: {why.rstrip('.')}." if why else ""
        how = package_managers.command(manager, [need], root=root)
        say(f"Without {need.what.partition(',')[0]}: {need.lost}.{reason} To install it: {how}")
    return False


def make_venv(python: machine.Python, ros: Optional[machine.SourcedRos]) -> bool:
    """Create .venv, replacing an existing folder. Return False if Python could not create .venv."""
    say("Creating .venv with Python {}.{}.{} ({})".format(*python.version, python.path))
    options = ["--clear"]
    if ros:
        say(f"ROS 2 Jazzy is sourced from {ros.prefix}: it is used, and no other ROS 2 is installed")
        options.append("--system-site-packages")
    making = interpreter.interpreter(
        "-m", "venv", *options, str(VENV), python=python.path, env=installers.environment(os.environ)
    )
    try:
        # Show the output only if the command fails. In that case, the output contains the reason.
        subprocess.check_output(making.argv, stderr=subprocess.STDOUT, env=making.env, cwd=str(ROOT))
    except subprocess.CalledProcessError as error:
        said = error.output.decode(errors="replace")
        known = setup_errors.of_output(said, VENV)
        unknown = f"{said}Python could not create {VENV}. Its messages are above."
        terminal_text.say(known or unknown)
        return False
    return True


def read_arguments(arguments: Sequence[str]) -> argparse.Namespace:
    """Parse the arguments: `parts` is a name in PARTS, and `python` is None by default."""
    parser = argparse.ArgumentParser(prog="python3 -m grader.setup.bootstrap", description=__doc__.splitlines()[0])
    parser.add_argument("parts", choices=list(PARTS), help="what to install into .venv; other parts in it are kept")
    parser.add_argument("--python", type=requested_python, help="the Python for .venv: a name or a path")
    return parser.parse_args(arguments)


def requested_python(name: str) -> machine.Python:
    """Return the interpreter with this name or path. Raises ArgumentTypeError if the interpreter does not run."""
    python = machine.probe(shutil.which(name) or name)
    if python is None:
        message = f"{name} is not a Python that runs on this machine"
        raise argparse.ArgumentTypeError(message)
    return python


def wait_for(lock: TextIO) -> None:
    """Wait until no other set-up of this folder is running, and keep others waiting until `lock` is closed."""
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        say("Waiting for another process, which is setting up this folder")
        fcntl.flock(lock, fcntl.LOCK_EX)


def main(arguments: Sequence[str]) -> int:
    """Create or update .venv. Return the exit code."""
    requested = read_arguments(arguments)
    ros = machine.sourced_ros(os.environ, VENV)
    problem = machine.platform_problem(platform.system(), platform.machine(), platform.libc_ver(), ros)
    problem = problem or place_problem(ROOT)
    if problem:
        terminal_text.say(problem)
        return MACHINE_BROKEN
    with (ROOT / "requirements.lock").open() as lock:
        wait_for(lock)
        remove_incomplete(ROOT / "grader")
        if os.getuid() == 0:
            # Cells run as another user, who must be able to read .venv and the grader.
            os.umask(0o022)
            make_readable(ROOT / "grader")
        return set_up(PARTS[requested.parts], ros, requested.python)


def set_up(parts: List[str], ros: Optional[machine.SourcedRos], wanted: Optional[machine.Python]) -> int:
    """Inspect the machine, then create and fill .venv if necessary. Return the exit code."""
    kind = ros.prefix if ros else WHEELS
    stamp = read_stamp()
    made = stamp is not None and stands(stamp, ros, wanted)
    whole = stamp and made and stamp.digest == digest() and set(parts) <= set(stamp.parts)
    unfinished = not (whole and finds_course())
    python, needs = look(ros, wanted, parts, made=made)
    why = ""
    # Install missing optional programs only if other parts have to be set up, not on every run.
    if any(unfinished or not need.lost for need in needs):
        why = provide(needs, os.environ, say)
        python, needs = look(ros, wanted, parts, made=made)
    if report_missing(needs, why):
        return MACHINE_BROKEN

    if not unfinished:
        return 0
    if STAMP.exists():
        STAMP.unlink()  # .venv is incomplete from here until the end
    if stamp and made:
        # Keep the parts that are already installed: a machine may be part of a cluster and also have notebooks.
        parts = [part for part in PARTS["tests"] if part in parts or part in stamp.parts]
        stamp = stamp._replace(digest=digest(), parts=parts, seconds={})
    elif python:
        if stamp and ros is None and stamp.ros != WHEELS:
            say(
                f"This set-up was made for the ROS 2 in {stamp.ros}, which is not sourced. The "
                f"course is set up again with its own ROS 2; your installation is not changed"
            )
        if machine.is_offline(os.environ):
            terminal_text.say(setup_errors.NO_NETWORK.format("it has no network"))
            return MACHINE_BROKEN
        begin = time.monotonic()
        if not make_venv(python, ros):
            return MACHINE_BROKEN
        seconds = {"environment": time.monotonic() - begin}
        stamp = Stamp(str(ROOT), kind, python.path, list(python.version), digest(), parts, seconds)
    install = interpreter.interpreter(
        *("-m", "grader.setup.install", json.dumps(stamp._asdict() if stamp else {})),
        python=str(PYTHON),
        env=installers.environment(os.environ),
        root=ROOT,
    )
    return subprocess.call(install.argv, env=install.env, cwd=str(ROOT))


if __name__ == "__main__":
    setup_errors.run_and_exit(lambda: main(sys.argv[1:]))
