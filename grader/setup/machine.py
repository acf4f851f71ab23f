"""The properties of this machine (Pythons, a sourced ROS 2, system programs), and messages about missing programs.

The set-up uses this module with any `python3`, before anything is installed. With an old Python, users must get a
message instead of a SyntaxError. Therefore, this module, bootstrap.py and all modules that they import use only the
syntax of Python 3.6 and the standard library.
"""

import json
import os
import shutil
import stat
import subprocess
from pathlib import Path
from typing import Iterable, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple

from grader.common import package_managers
from grader.common.interpreter import clean, interpreter
from grader.common.package_managers import Need
from grader.common.system_errors import of_the_machine
from grader.setup import installers

OLDEST, NEWEST = (3, 10), (3, 14)
BROWSERS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
"""The browsers for the tests of the pages. The first one cannot open windows, and needs about half as much CPU time."""
SYSTEM_PATH = ("/usr/local/bin", "/usr/bin", "/bin")
NO_SANDBOX = (
    "only your own code can be checked, with limits on time, memory, processes and file size; "
    "grading for marks needs the sandbox"
)

CONTAINER = """\
  - a container, started in this folder (--privileged, since the grader creates its own sandboxes):
      docker run --rm -it --privileged --platform linux/amd64 -v "$PWD":/course -w /course debian:12 \\
          bash -c "apt-get update && apt-get install -y make python3 && CI=true make demo; exec bash"
  - your own ROS 2 Jazzy, on any Linux: source /opt/ros/jazzy/setup.bash, then run make again."""

LEFT_TO_ROS = {"numpy": "python3-numpy", "em": "python3-empy", "lark": "python3-lark"}
"""The modules that the set-up does not install if a ROS 2 is sourced, and the Debian package of each module.

With a sourced ROS 2, install.py leaves out lock.SOURCED_BRINGS, pytest and the part `ros` of the lock file. It installs
another version of pytest and, if the system has no usable numpy, of numpy.
"""
_IMPORTS = """
import importlib, json, sys
def lacks(name):
    try:
        importlib.import_module(name)
    except Exception:
        return True
print(json.dumps([name for name in sys.argv[1:] if lacks(name)]))
"""
_PROBE = """
import importlib.util, json, os, platform, sys, sysconfig
print(json.dumps({
    "path": os.path.realpath(getattr(sys, "_base_executable", None) or sys.executable),
    "version": list(sys.version_info[:3]),
    "cpython": platform.python_implementation() == "CPython" and not sysconfig.get_config_var("Py_GIL_DISABLED"),
    "venv": all(importlib.util.find_spec(name) for name in ("venv", "ensurepip")),
    "headers": os.path.isfile(os.path.join(sysconfig.get_path("include"), "Python.h")),
}))
"""


class Python(NamedTuple):
    """A Python interpreter.

    `path` contains no symlinks, and `cpython` says whether the interpreter is a CPython that the ROS 2 wheels support.
    """

    path: str
    version: Tuple[int, int, int]
    cpython: bool
    venv: bool
    headers: bool
    lacks: Tuple[str, ...] = ()
    """The modules in LEFT_TO_ROS that this Python interpreter cannot import."""

    @property
    def is_systems(self) -> bool:
        """Whether the system's package manager installed the interpreter, and can install its missing parts."""
        return Path(self.path).parent == Path("/usr/bin")


class SourcedRos(NamedTuple):
    """A sourced ROS 2 Jazzy: its prefix, the (major, minor) version of its Python, and whether it has turtlesim."""

    prefix: str
    python: Tuple[int, int]
    turtlesim: bool


def sourced_ros(env: Mapping[str, str], ours: Path) -> Optional[SourcedRos]:
    """Return the sourced ROS 2 Jazzy, or None.

    The wheels of this course (in the folder `ours`) and those of other clones of the course are ignored.
    """
    if env.get("ROS_DISTRO") != "jazzy":
        return None
    for prefix in map(Path, clean(env).get("AMENT_PREFIX_PATH", "").split(os.pathsep)):
        index = prefix / "share/ament_index/resource_index/packages"
        if prefix == ours or (prefix / "course-setup.json").is_file() or not (index / "rclpy").is_file():
            continue
        for minor in range(OLDEST[1], NEWEST[1] + 1):
            if (prefix / f"lib/python3.{minor}/site-packages/rclpy").is_dir():
                return SourcedRos(str(prefix), (3, minor), (index / "turtlesim").is_file())
    return None


def platform_problem(system: str, machine: str, libc: Tuple[str, str], ros: Optional[SourcedRos]) -> str:
    """Return a text that says why the ROS 2 wheels cannot be installed here and what to do, or an empty string.

    The arguments are platform.system(), platform.machine() and platform.libc_ver().
    """
    if system == "Linux" and ros:
        return ""
    if system != "Linux" or machine != "x86_64":
        observed = "{} on {}".format({"Darwin": "macOS"}.get(system, system or "unknown"), machine or "unknown")
    elif libc[0] != "glibc":
        observed = "a Linux with a C library other than glibc"
    elif tuple(int(number) for number in libc[1].split(".")[:2]) < (2, 28):
        observed = f"a Linux with glibc {libc[1]}"
    else:
        return ""
    return (
        "The course installs ROS 2 from packages for Linux on x86-64 with glibc 2.28 or newer (Debian 10, "
        f"Ubuntu 20.04 or later). This is {observed}.\nYou can use one of these instead:\n{CONTAINER}"
    )


def is_offline(env: Mapping[str, str], root: Path = Path("/")) -> bool:
    """Return whether the machine has no route to a network, so that no packages can be downloaded.

    The result is False if a variable or a configuration file for pip, uv or a proxy exists, since it may name a mirror
    or a folder of wheels. `root` is the folder that contains proc/.
    """
    settings = ("PIP_", "UV_", "HTTP_PROXY", "HTTPS_PROXY", "ALL_PROXY")
    home = Path(env.get("HOME", "/nowhere"))
    files = [*installers.configuration_files(env, root), home / ".config/uv/uv.toml"]
    if any(name.upper().startswith(settings) for name in env) or any(file.exists() for file in files):
        return False
    try:
        routes = (root / "proc/net/route").read_text().splitlines()[1:]
        routes += (root / "proc/net/ipv6_route").read_text().splitlines()
    except OSError:
        return False
    return all(line.split()[-1] == "lo" for line in routes if line.strip())


def closed_folder(path: str) -> Optional[Path]:
    """Return the topmost folder above `path` that other users cannot enter, or None."""
    folders = Path(path).resolve().parents
    return next((folder for folder in reversed(list(folders)) if not folder.stat().st_mode & stat.S_IXOTH), None)


def probe(executable: str) -> Optional[Python]:
    """Return the properties of an interpreter, or None if it does not run (for example, a shim for a missing Python).

    Raises:
        OSError: the machine cannot start another process.
    """
    try:
        asking = interpreter("-c", _PROBE, python=executable)
        output = subprocess.check_output(asking.argv, env=asking.env, stderr=subprocess.DEVNULL, timeout=30)
        answer = json.loads(output.decode())
    except (OSError, ValueError, subprocess.SubprocessError) as error:
        if isinstance(error, OSError) and of_the_machine(error):
            raise
        return None
    return Python(answer["path"], tuple(answer["version"]), answer["cpython"], answer["venv"], answer["headers"])


def for_ros(python: Python, ros: SourcedRos) -> Python:
    """Return the interpreter. If its version is right for this ROS 2, add the list of the modules that it lacks."""
    if python.version[:2] != ros.python or not python.cpython:
        return python
    # Like .venv, use the system's packages, but not those in the user's home.
    env = {**os.environ, "PYTHONNOUSERSITE": "1"}
    asking = interpreter("-c", _IMPORTS, *LEFT_TO_ROS, python=python.path, env=env, searches=True)
    try:
        output = subprocess.check_output(asking.argv, env=asking.env, stderr=subprocess.DEVNULL, timeout=60)
        return python._replace(lacks=tuple(json.loads(output.decode())))
    except (OSError, ValueError, subprocess.SubprocessError):
        return python._replace(lacks=tuple(LEFT_TO_ROS))


def find_pythons(path: str) -> Iterator[Python]:
    """Yield the interpreters on PATH and in the system's folders: first `python3`, then all others, newest first."""
    folders = list(dict.fromkeys([*filter(None, path.split(os.pathsep)), *SYSTEM_PATH]))
    observed = set()
    for name in ["python3", *(f"python3.{minor}" for minor in range(NEWEST[1], OLDEST[1] - 1, -1))]:
        for executable in [Path(folder, name) for folder in folders]:
            python = probe(str(executable)) if os.access(str(executable), os.X_OK) else None
            if python and python.path not in observed:
                observed.add(python.path)
                yield python


def choose_python(
    pythons: Iterable[Python], *, root: bool, wanted: Optional[Tuple[int, int]] = None
) -> Optional[Python]:
    """Return the first suitable interpreter for .venv. Complete interpreters are preferred to incomplete ones.

    For root, an interpreter that other users can also run (not in root's home) is preferred, since the sandbox drops
    root's rights. `wanted` is the only suitable (major, minor) version: the version that a sourced ROS 2 was built for.
    """
    best: Optional[Tuple[Tuple[bool, bool, bool], Python]] = None
    for python in pythons:
        fits = python.version[:2] == wanted if wanted else OLDEST <= python.version[:2] <= NEWEST
        lacks = not (python.venv and python.headers) or bool(python.lacks)
        # The package manager cannot add missing parts to a Python that it did not install.
        if not python.cpython or not fits or (lacks and not python.is_systems):
            continue
        rank = (bool(python.lacks), root and closed_folder(python.path) is not None, lacks)
        if best is None or rank < best[0]:
            best = (rank, python)
        if not any(rank):
            break
    return best[1] if best else None


def missing_tools(path: str, ros: Optional[SourcedRos]) -> List[Need]:
    """Return the missing programs. A compiler, cmake and make are not needed if the sourced ROS 2 has turtlesim."""
    tools = {"bwrap": Need("bubblewrap, the sandbox that student code runs in", "bubblewrap", NO_SANDBOX)}
    limits = Need("setpriv, prlimit and choom, which set the sandbox's limits", "util-linux")
    tools.update({"setpriv": limits, "prlimit": limits, "choom": limits})
    if not (ros and ros.turtlesim):
        tools["g++"] = Need("a C++ compiler, for turtlesim's messages", "g++")
        tools["cmake"] = Need("cmake, for turtlesim's messages", "cmake")
        tools["make"] = Need("make, for turtlesim's messages", "make")
    search = os.pathsep.join([path, *SYSTEM_PATH])
    return list(dict.fromkeys(need for name, need in tools.items() if shutil.which(name, path=search) is None))


def missing_of_tests(path: str) -> List[Need]:
    """Return the missing programs that only some tests need. The other tests run without these programs."""
    tools = {
        BROWSERS: Need("a browser", "chromium-headless-shell", "the tests of the pages do not run"),
        ("shellcheck",): Need("shellcheck", "shellcheck", "the test of the shell scripts does not run"),
        ("zsh",): Need("zsh", "zsh", "the tests of setup.zsh do not run"),
    }
    search = os.pathsep.join([path, *SYSTEM_PATH])
    return [need for names, need in tools.items() if not any(shutil.which(name, path=search) for name in names)]


def missing_of_python(
    python: Optional[Python],
    wanted: Optional[Tuple[int, int]] = None,
    newer: str = "",
    refused: Sequence[Python] = (),
) -> List[Need]:
    """Return the missing parts of the chosen Python, or all parts if no Python was chosen.

    `newer` is the package of a newer Python for a system whose default Python is too old. `refused` contains the
    Pythons of the `wanted` version that cannot import the modules that the sourced ROS 2 needs.
    """
    if python is None:
        name = f"python{wanted[0]}.{wanted[1]}" if wanted else newer or "python3"
        what = f"CPython {wanted[0]}.{wanted[1]}" if wanted else f"CPython 3.{OLDEST[1]} to 3.{NEWEST[1]}"
        if refused:
            why = "; ".join("{} cannot import {}".format(p.path, " and ".join(p.lacks)) for p in refused)
            what += f" that can import what the sourced ROS 2 needs ({why})"
            what += "; set PYTHON=/path/to/python3 to use another one"
            return [Need(what, package) for package in (name, *LEFT_TO_ROS.values())]
        return [Need(what + " with its headers", name + part) for part in ("", "-venv", "-dev")]
    default = os.path.realpath("/usr/bin/python3") == python.path
    name = "python3" if default else f"python{python.version[0]}.{python.version[1]}"
    needs = []
    if not python.venv:
        needs.append(Need("Python's module venv, which creates the course's environment", name + "-venv"))
    if not python.headers:
        needs.append(Need("Python's headers (Python.h), for turtlesim's messages", name + "-dev"))
    which = "which the sourced ROS 2 needs; set PYTHON=/path/to/python3 to use a Python that has it"
    needs += [Need(f"the module {name}, {which}", LEFT_TO_ROS[name]) for name in python.lacks]
    return needs


def lack_message(
    needs: Sequence[Need], manager: Optional[package_managers.Manager], *, root: bool, why: str = ""
) -> str:
    """Return a message with the missing programs, the command that installs them, and `why` they were not installed."""
    whats = [f"  - {what}" for what in dict.fromkeys(need.what for need in needs)]
    them, parts = ("it", "part was") if len(whats) == 1 else ("them", "parts were")
    lines = ["The course needs the following, which this system does not have:", *whats]
    lines += [f"The missing {parts} not installed: {why}."] if why else []
    how = package_managers.command(manager, needs, root=root)
    if manager is None:
        lines.append(f"Install {them} with {how}, then run make again.")
    else:
        lines += [f"Install {them} with this command, then run make again:", "", "    " + how, ""]
    if any(need.what.startswith("CPython") for need in needs):
        lines += [
            "If the system's Python is older, use a newer system (Debian 12, Ubuntu 22.04), or",
            CONTAINER,
        ]
    return "\n".join(lines)
