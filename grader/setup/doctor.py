"""`grader doctor`: check whether this machine has everything that grading needs.

Each line of the output reports what was observed. If the user can improve something, the line also states what to do.
If possible, the command runs real tests: it builds the turtlesim interfaces if necessary, and starts a publishing node
in a cell.
"""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from dataclasses import dataclass
from importlib import metadata
from importlib.util import find_spec
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Literal

from rich.text import Text

from grader.common import package_managers, xdg
from grader.common.terminal_text import hanging
from grader.common.words import count
from grader.errors import MachineError
from grader.ros import underlay
from grader.ros.installation import DISTRO, Ros, find_ros
from grader.sandbox import bubblewrap
from grader.sandbox.control_group import control_group
from grader.sandbox.limits import NODE_LIMITS
from grader.setup import bootstrap, machine
from grader.setup.node_test import why_not_heard
from grader.setup.user_limits import shares
from grader.submission import reader

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from rich.console import Console

BROKEN_EXIT_CODE = 3
GIB = 1024**3
LEAST_DISK = GIB // 4
LITTLE_DISK = 2 * GIB
LITTLE_MEMORY = 1 * GIB
NARROW = 60
"""On a terminal with fewer columns than this, continuation lines are indented by 4 columns instead of 20."""


@dataclass(frozen=True)
class Line:
    """The result of one test of the machine.

    A line with the state `broken` means that the machine cannot grade. Lines with other states do not prevent grading.
    """

    subject: str
    observed: str
    state: Literal["ok", "advice", "broken"] = "ok"
    todo: str = ""


def run_doctor(env: Mapping[str, str] = os.environ, tell: Callable[[str], None] = lambda _: None) -> list[Line]:
    """Run the tests, and return their lines. `tell` is called before the turtlesim interfaces are built.

    The tests of turtlesim and of a node are left out if a test that they depend on fails.
    """
    lines = [look_at_system(), look_at_python(), *look_at_set_up(env), *look_at_tools(env), look_at_colcon()]
    lines += [look_at_disk(xdg.cache()), look_at_memory(Path("/proc/meminfo").read_text(encoding="ascii"))]
    observed, todo = shares()
    lines.append(Line("shares", observed, "advice" if todo else "ok", todo))
    sandbox_line = look_at_sandbox()
    confined = sandbox_line.state == "ok"
    lines.append(sandbox_line)
    if confined:
        lines.append(look_at_limits())
    lines.append(look_at_reading())
    try:
        ros = find_ros(env)
    except MachineError as error:
        return [*lines, Line("ROS 2", "not found", "broken", str(error))]
    lines.append(look_at_ros(ros, env))
    try:
        ros = underlay.with_turtlesim(ros, tell)
    except MachineError as error:
        return [*lines, Line("turtlesim", "its interfaces cannot be used", "broken", str(error))]
    where = f"the course's own interfaces, built in {ros.underlay}" if ros.underlay else "part of ROS 2"
    lines.append(Line("turtlesim", where))
    return [*lines, look_at_node(ros, confined=confined)]


def exit_code(lines: Iterable[Line]) -> int:
    """Return 3 if a line has the state `broken`, and 0 otherwise."""
    return BROKEN_EXIT_CODE if any(line.state == "broken" for line in lines) else 0


def render(lines: Iterable[Line], console: Console) -> None:
    """Print the lines, as plain text if the console is not a terminal."""
    styles = {"ok": "green", "advice": "yellow", "broken": "bold red"}
    width = console.width if console.is_terminal else None
    indent = " " * (4 if width and width < NARROW else 20)
    for line in lines:
        shown = Text(hanging(line.observed, width, f"{line.state:<8}{line.subject:<12}", indent))
        shown.stylize(styles[line.state], 0, 8)
        console.print(shown, soft_wrap=True)
        if line.todo:
            console.print(Text(hanging(line.todo, width, f"{indent}-> ", indent)), soft_wrap=True)


# --- what is installed -------------------------------------------------------------------------------------


def look_at_system() -> Line:
    """Return a line with the distribution, the kernel, the architecture and the number of cores."""
    observed = f"{_distribution()}, {platform.system()} on {platform.machine()}, {count(os.cpu_count() or 1, 'core')}"
    return Line("system", observed)


def look_at_python() -> Line:
    """Return a line that names this interpreter and says whether the course supports it."""
    observed = f"CPython {platform.python_version()}, {Path(sys.executable).parent}"
    if machine.OLDEST <= sys.version_info[:2] <= machine.NEWEST:
        return Line("Python", observed)
    versions = f"3.{machine.OLDEST[1]} to 3.{machine.NEWEST[1]}"
    return Line("Python", observed, "broken", f"ROS 2 Jazzy needs Python {versions}: make demo PYTHON=python3.12")


def look_at_set_up(env: Mapping[str, str], stamp: bootstrap.Stamp | None = None) -> Iterator[Line]:
    """Yield a line that says whether .venv matches the current lock file and the sourced ROS 2."""
    stamp = stamp or bootstrap.read_stamp()
    if stamp is None or Path(sys.prefix) != bootstrap.VENV:
        yield Line("set-up", "not created or not finished by `make`; versions may differ from the lock file")
        return
    ros = machine.sourced_ros(env, bootstrap.VENV)
    now = ros.prefix if ros else bootstrap.WHEELS
    made_for = "the course's own ROS 2" if stamp.ros == bootstrap.WHEELS else stamp.ros
    if stamp.digest != bootstrap.digest():
        yield Line("set-up", "made from other versions of the course's files", "advice", "make demo")
    elif os.path.realpath(stamp.ros) == os.path.realpath(now):
        yield Line("set-up", "matches the lock file")
    elif now == bootstrap.WHEELS:
        todo = f"source {quote(f'{stamp.ros}/setup.bash')}; or make demo, for the course's own ROS 2"
        yield Line("set-up", f"made for {made_for}, which is not sourced", "broken", todo)
    else:
        observed = f"made for {made_for}, but {now} is sourced and used"
        yield Line(
            "set-up",
            observed,
            "advice",
            "nothing, if the lines below are ok; otherwise type in this terminal: make demo",
        )


def look_at_tools(env: Mapping[str, str]) -> Iterator[Line]:
    """Yield lines about build tools and Python's headers, and one with the command that installs missing programs."""
    ros = machine.sourced_ros(env, bootstrap.VENV)
    needs = machine.missing_tools(env.get("PATH", ""), ros)
    headers = Path(sysconfig.get_path("include"), "Python.h").is_file()
    builds = not (ros and ros.turtlesim)
    if builds and not headers:
        needs.append(package_managers.Need("Python's headers (Python.h)", f"python3.{sys.version_info.minor}-dev"))
    for name in ("g++", "cmake", "make") if builds else ():
        version = _version_of(name)
        if version:
            yield Line(name, version)
    if builds and headers:
        yield Line("headers", "Python.h is installed")
    # Optional programs have separate lines, which state what does not work without them.
    needs = [need for need in needs if not need.lost]
    if needs:
        observed = "missing: " + "; ".join(need.what for need in needs)
        manager = package_managers.find_manager(env.get("PATH", ""))
        yield Line("programs", observed, "broken", package_managers.command(manager, needs, root=os.getuid() == 0))


def look_at_colcon() -> Line:
    """Return a line that says whether colcon, which builds submissions, is installed in this Python."""
    try:
        version = metadata.version("colcon-core")
    except metadata.PackageNotFoundError:
        return Line("colcon", "not installed in this Python", "broken", "make demo")
    if find_spec("em") is None:
        return Line("colcon", f"colcon-core {version}, which does not start without empy", "broken", "make demo")
    return Line("colcon", f"colcon-core {version}, colcon-ros {metadata.version('colcon-ros')}")


def look_at_disk(folder: Path) -> Line:
    """Return a line with the free space on the disk for the built interfaces."""
    there = next(path for path in [folder, *folder.parents] if os.path.isdir(path))  # noqa: PTH112 - Path.is_dir raises PermissionError
    free = shutil.disk_usage(there).free
    observed = f"{free / GIB:.1f} GiB free for {folder}"
    if free >= LITTLE_DISK:
        return Line("disk", observed)
    return Line(
        "disk",
        observed,
        "broken" if free < LEAST_DISK else "advice",
        "free some space, or set XDG_CACHE_HOME to another folder",
    )


def look_at_memory(meminfo: str) -> Line:
    """Return a line with the memory that is available to programs. `meminfo` is the content of /proc/meminfo."""
    kib = next((int(line.split()[1]) for line in meminfo.splitlines() if line.startswith("MemAvailable:")), None)
    if kib is None:
        return Line("memory", "unknown: the system does not report it")
    observed = f"{kib * 1024 / GIB:.1f} GiB available"
    if kib * 1024 >= LITTLE_MEMORY:
        return Line("memory", observed)
    return Line("memory", observed, "advice", "close other programs, or grade one submission at a time")


def look_at_ros(ros: Ros, env: Mapping[str, str]) -> Line:
    """Return a line that names the ROS 2 that grading uses, and says whether it matches this Python."""
    sourced = machine.sourced_ros(env, bootstrap.VENV)
    if ros.kind == "sourced" and sourced and sourced.python != sys.version_info[:2]:
        wanted = ".".join(map(str, sourced.python))
        return Line("ROS 2", f"{ros.name}, for Python {wanted}", "broken", "type in this terminal: make demo")
    other = env.get("ROS_DISTRO", DISTRO)
    if other != DISTRO:
        return Line("ROS 2", f"{ros.name}; {other} is sourced, but not used", "advice", "nothing, if this is intended")
    return Line("ROS 2", f"{ros.name}" + (f", {ros.prefix}" if ros.kind == "sourced" else ""))


# --- what must be tested ------------------------------------------------------------------------------


def look_at_sandbox() -> Line:
    """Return a line that says whether this machine can create sandbox cells, in which students' processes run.

    Sandbox cells are optional for users who check only their own code.
    """
    why = bubblewrap.why_unavailable()
    if why is None:
        return Line("sandbox", "bubblewrap can create sandboxes")
    return Line("sandbox", f"none: {machine.NO_SANDBOX}", "advice", why)


def look_at_limits() -> Line:
    """Return a line that says how the memory and the processes of a sandbox cell are limited."""
    with control_group(NODE_LIMITS) as group:
        if group:
            return Line("limits", "the kernel limits the memory and the processes of a sandbox")
    return Line(
        "limits",
        "the grader measures a sandbox's memory ten times per second, since it cannot use control groups",
    )


def look_at_reading() -> Line:
    """Return a line that says which files the process that reads submissions can open."""
    if reader.is_confined():
        return Line("reading", "the process that reads a submission can open only the submission and program files")
    return Line(
        "reading",
        "the process that reads a submission can open all files of this user",
        "advice",
        "use a kernel with Landlock (Linux 5.13 or later), or allow user namespaces, to grade other people's work",
    )


def look_at_node(ros: Ros, *, confined: bool = True) -> Line:
    """Test the interpreter, ROS 2, the network and the interfaces: one node publishes to another, as in a trial.

    If `confined` is True, the publisher is in a cell, and the other node is outside.
    """
    why = why_not_heard(ros, confined=confined)
    if why is None:
        return Line(
            "a node", "starts in a sandbox; its messages arrive outside" if confined else "starts; its messages arrive"
        )
    closed = machine.closed_folder(os.path.realpath(sys.executable))
    todo = "please report this with all lines above"
    if closed and os.getuid() == 0:
        todo += f"; or allow other users to access {closed}, which contains this Python"
    return Line("a node", f"its messages do not arrive{' from a sandbox' if confined else ''}: {why}", "broken", todo)


def _distribution() -> str:
    try:
        return platform.freedesktop_os_release()["PRETTY_NAME"]
    except (OSError, KeyError):
        return "an unnamed system"


def _version_of(program: str) -> str | None:
    path = shutil.which(program, path=os.pathsep.join([os.environ.get("PATH", ""), *machine.SYSTEM_PATH]))
    if path is None:
        return None
    done = subprocess.run([path, "--version"], capture_output=True, text=True, check=False, cwd=tempfile.gettempdir())
    return next(iter(done.stdout.splitlines()), path)
