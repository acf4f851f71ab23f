"""Find the ROS 2 installation, and create the environment that child processes need for it.

If no ROS 2 Jazzy is sourced, the wheels in this Python's environment are used. The process of the command `grader`
never imports rclpy. All ROS 2 code runs in other processes, with the environment that this module creates.
"""

from __future__ import annotations

import json
import os
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Literal

from grader.common import xdg
from grader.common.private_folder import users_folder
from grader.errors import MachineError, UsageError
from grader.ros.domain import wrong_domain

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

DISTRO = "jazzy"
SEARCHED = ("AMENT_PREFIX_PATH", "CMAKE_PREFIX_PATH", "LD_LIBRARY_PATH", "PYTHONPATH")
"""The environment variables that hold the search paths of ROS 2 and its overlays."""
FASTDDS_PROFILE = Path(__file__).with_name("fastdds.xml")
_UNWATCHED = (
    *("ROS_LOG_DIR", "RCUTILS_COLORIZED_OUTPUT", "OPENBLAS_NUM_THREADS", "MALLOC_ARENA_MAX"),
    *("PYTHONHASHSEED", "PYTHONNOUSERSITE", "PYTHONUNBUFFERED"),
)
"""Variables that are set only for processes that the grader starts. A node that a user starts uses the user's
settings. If the home folder is not writable, however, such a node gets a ROS_LOG_DIR in a temporary folder."""
_THEIRS = frozenset(
    {
        *("LANG", "ROS_DOMAIN_ID", "ROS_AUTOMATIC_DISCOVERY_RANGE", "RMW_IMPLEMENTATION"),
        *("FASTDDS_BUILTIN_TRANSPORTS", "FASTRTPS_DEFAULT_PROFILES_FILE"),
    }
)
"""Variables whose values are kept if the user has set them. The wheels do not use the user's RMW_IMPLEMENTATION."""
PYTHON_LIB = Path(f"lib/python{sys.version_info.major}.{sys.version_info.minor}/site-packages")
"""The folder of Python packages, relative to a prefix."""


@dataclass(frozen=True)
class Ros:
    """A ROS 2 installation. The lists of paths are in search order."""

    kind: Literal["sourced", "wheels"]
    version: str
    """The version of rclpy."""
    prefix: Path
    """The ament prefix that holds rclpy, for example /opt/ros/jazzy."""
    prefixes: tuple[Path, ...]
    python: Path
    python_path: tuple[Path, ...]
    library_path: tuple[Path, ...]
    underlay: Path | None = None
    """The prefix of the turtlesim interfaces that grader.ros.underlay has added, or None if it has added none."""

    @property
    def name(self) -> str:
        """The name of this ROS 2 installation, as it appears in reports.

        The name contains no paths, so reports from different machines are identical.
        """
        return f"Jazzy (rclpy {self.version}, {'sourced' if self.kind == 'sourced' else 'wheels'})"

    @property
    def all_prefixes(self) -> tuple[Path, ...]:
        """The ament prefixes, including the underlay, if any."""
        return (*self.prefixes, *([self.underlay] if self.underlay else []))


def find_ros(env: Mapping[str, str] = os.environ) -> Ros:
    """Return the ROS 2 Jazzy to use: the sourced installation, or else the wheels in this Python environment.

    Raises:
        MachineError: no ROS 2 Jazzy is sourced, and the wheels are not installed.
    """
    ros = _sourced(env) or _wheels(Path(sys.prefix))
    if ros is None:
        raise MachineError(_why_none(env))
    return ros


def _why_none(env: Mapping[str, str]) -> str:
    """Return a message that explains why no ROS 2 Jazzy was found and which command to type."""
    made = made_for(Path(sys.prefix))
    if made is not None:
        return (
            f"This course was set up for the ROS 2 in {made}, which is not sourced in this terminal. "
            f"Type: source {quote(f'{made}/setup.bash')}"
        )
    distro = env.get("ROS_DISTRO")
    found = f"ROS 2 {distro.capitalize()} is sourced, and no" if distro and distro != DISTRO else "No"
    return (
        f"{found} ROS 2 Jazzy was found. Run `make demo` in the course's folder, which installs it into .venv, "
        "and `source .venv/setup.bash`; or source your own: `source /opt/ros/jazzy/setup.bash`."
    )


def made_for(prefix: Path) -> str | None:
    """Return the prefix of the sourced ROS 2 that .venv was set up for, or None if no such prefix is known."""
    try:
        ros = json.loads((prefix / "course-setup.json").read_text(encoding="utf-8"))["ros"]
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return ros if isinstance(ros, str) and ros.startswith("/") else None


def environment(ros: Ros, *, home: Path, overlays: Sequence[Path] = (), domain: int | None = 0) -> dict[str, str]:
    """Return the complete environment of a child process. Nothing is inherited from the caller's environment.

    `overlays` are install folders of packages (install/<package>), and are searched first. `home` becomes HOME and
    contains ROS_LOG_DIR, so it must be writable. `domain` is None in a sandbox room (grader.sandbox), because a room
    has its own network.
    """
    local = [*overlays, *([ros.underlay] if ros.underlay else [])]
    env = {
        "PATH": os.pathsep.join([str(ros.python.parent), "/usr/local/bin", "/usr/bin", "/bin"]),
        "HOME": str(home),
        "LANG": "C.UTF-8",
        "PYTHONNOUSERSITE": "1",
        # Sets have the same order in every run, so that equal submissions get equal reports.
        "PYTHONHASHSEED": "0",
        # Every printed line arrives immediately, as on a terminal.
        "PYTHONUNBUFFERED": "1",
        # numpy, which geometry_msgs imports, would start one thread per processor. These threads busy-wait for 0.1 s.
        "OPENBLAS_NUM_THREADS": "1",
        # glibc reserves 64 MiB of address space, which is limited, for each new thread, until there are 8 such arenas
        # per processor. With the number for two processors, the same threads fit on every machine.
        "MALLOC_ARENA_MAX": "16",
        "ROS_DISTRO": DISTRO,
        "ROS_VERSION": "2",
        "ROS_PYTHON_VERSION": "3",
        "ROS_LOG_DIR": str(home / "log"),
        "ROS_DOMAIN_ID": str(domain or 0),
        # LOCALHOST enables shared memory again despite the transports below, but a room and a cell share no memory.
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "SUBNET" if domain is None else "LOCALHOST",
        "RCUTILS_COLORIZED_OUTPUT": "0",
        "AMENT_PREFIX_PATH": os.pathsep.join(map(str, [*local, *ros.prefixes])),
        "CMAKE_PREFIX_PATH": os.pathsep.join(map(str, [*local, *ros.prefixes])),
        "LD_LIBRARY_PATH": os.pathsep.join(map(str, [*(p / "lib" for p in local), *ros.library_path])),
        "PYTHONPATH": os.pathsep.join(map(str, [*(p / PYTHON_LIB for p in local), *ros.python_path])),
        # Without this, the .pth file of the wheels would start every interpreter a second time and mix their libraries
        # with those of a sourced ROS.
        "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1",
        # `msg.linear.x = 2` raises a clear error instead of sending garbage.
        "ROS_PYTHON_CHECK_FIELDS": "1",
        # Shared memory requires a common /dev/shm, which a sandboxed node does not have.
        "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",
        "FASTRTPS_DEFAULT_PROFILES_FILE": str(FASTDDS_PROFILE),
        "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp",
    }
    return {key: value for key, value in env.items() if value}


def domain_of(uid: int) -> int:
    """Return the default ROS domain id of a user, from 1 to 101. Users with adjacent user ids get different domains.

    Domain 101 is the highest domain whose ports are below Linux's range of ephemeral ports.
    """
    return 1 + uid % 101


def users_environment(ros: Ros, env: Mapping[str, str] = os.environ, domain: int | None = None) -> dict[str, str]:
    """Return the environment of a node that a user starts: the user's environment with the variables of ROS 2 added.

    The user's settings are kept, and workspaces that the user sourced are searched first. The ROS domain is `domain`.
    If `domain` is None, it is the domain that the user has set. If the user has set none, it is 0 if the ROS 2
    installation was sourced, as for any node in such a terminal. Otherwise, it is the result of `domain_of` for the
    user id, so that classmates on one machine do not drive each other's turtles.

    Raises:
        UsageError: `domain` is None, and ROS_DOMAIN_ID is not a valid domain id.
        MachineError: the home folder is not writable, and no private folder for the logs could be created.
    """
    if domain is None and wrong_domain(env):
        raise UsageError(wrong_domain(env))
    home = xdg.home(env)
    own = 0 if ros.kind == "sourced" else domain_of(os.getuid())
    needed = environment(ros, home=home, domain=own)
    if ros.kind == "sourced":
        del needed["ROS_AUTOMATIC_DISCOVERY_RANGE"]
    for name in _UNWATCHED:
        needed.pop(name, None)
    if quote(str(ros.python)) != str(ros.python):
        # The setup.bash of a workspace does not quote the path of Python, so use the interpreter that the link points
        # to. The script needs only the standard library.
        needed["COLCON_PYTHON_EXECUTABLE"] = str(ros.python.resolve())
    if "ROS_LOG_DIR" not in env and "ROS_HOME" not in env and not os.access(home, os.W_OK):
        needed["ROS_LOG_DIR"] = str(users_folder() / "ros-log")
    joined = {name: _joined(name, needed, env) for name in SEARCHED if name in needed or name in env}
    joined["PATH"] = _users_path(ros, env)
    theirs = _THEIRS if ros.kind == "sourced" else _THEIRS - {"RMW_IMPLEMENTATION"}  # the wheels have only one
    kept = {key: value for key, value in env.items() if key in theirs or key not in needed}
    chosen = {"ROS_DOMAIN_ID": str(domain)} if domain is not None else {}
    return {**needed, **kept, **joined, **chosen}


def who_hears(env: Mapping[str, str]) -> str:
    """Return a message for the user that states the domain of the nodes in an environment and who can reach them."""
    domain, reach = env.get("ROS_DOMAIN_ID") or "0", env.get("ROS_AUTOMATIC_DISCOVERY_RANGE") or "SUBNET"
    if reach == "LOCALHOST" or env.get("ROS_LOCALHOST_ONLY") == "1":
        return f"ROS domain {domain}, reachable only on this machine"
    if reach == "SUBNET":
        return f"ROS domain {domain}, reachable from the network (ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST stops this)"
    note = ", so nodes do not find each other" if reach == "OFF" else ""
    return f"ROS domain {domain}, ROS_AUTOMATIC_DISCOVERY_RANGE={reach}{note}"


def _joined(name: str, needed: Mapping[str, str], env: Mapping[str, str]) -> str:
    """Return a search path that starts with the user's entries, except those of another ROS 2 or an older underlay."""
    ours = [entry for entry in needed.get(name, "").split(os.pathsep) if entry]
    prefixes = [Path(entry) for entry in env.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if entry]
    current = needed["AMENT_PREFIX_PATH"].split(os.pathsep)
    foreign = [p for p in prefixes if str(p) not in current and (_has(p, "rclpy") or p.name.startswith("turtlesim-"))]
    theirs = [entry for entry in env.get(name, "").split(os.pathsep) if entry and entry not in ours]
    kept = [entry for entry in theirs if not any(Path(entry).is_relative_to(prefix) for prefix in foreign)]
    return os.pathsep.join(dict.fromkeys([*kept, *ours]))


def _users_path(ros: Ros, env: Mapping[str, str]) -> str:
    """Return PATH with the course's bin folder. If it is missing, add it: last if a ROS 2 is sourced, else first."""
    path = env.get("PATH", "/usr/local/bin:/usr/bin:/bin")
    ours = str(Path(sys.prefix, "bin"))
    if ours in path.split(os.pathsep):
        return path
    return f"{path}{os.pathsep}{ours}" if ros.kind == "sourced" else f"{ours}{os.pathsep}{path}"


def _sourced(env: Mapping[str, str]) -> Ros | None:
    path = env.get("AMENT_PREFIX_PATH", "") if env.get("ROS_DISTRO") == DISTRO else ""
    others = (Path(p) for p in path.split(os.pathsep) if p and Path(p) != Path(sys.prefix))
    # The .venv of another clone of the course has a course-setup.json.
    prefix = next((p for p in others if _has(p, "rclpy") and not (p / "course-setup.json").exists()), None)
    if prefix is None:
        return None

    # Use only the entries of the installation. A workspace that a student sourced must not hide any of its packages.
    def own(variable: str) -> tuple[Path, ...]:
        entries = [Path(p) for p in env.get(variable, "").split(os.pathsep) if p]
        return tuple(p for p in entries if p.is_relative_to(prefix))

    return Ros(
        kind="sourced",
        version=_version(prefix),
        prefix=prefix,
        prefixes=(prefix,),
        python=_this_python(Path(sys.executable)),
        python_path=own("PYTHONPATH"),
        library_path=own("LD_LIBRARY_PATH"),
    )


def _this_python(started: Path) -> Path:
    """Return the path of `python3` next to `started` if both are the same interpreter, or else `started`.

    The underlay's key contains the path. Without this function, a start as `python` would build the underlay again.
    """
    usual = started.with_name("python3")
    return usual if usual.exists() and usual.samefile(started) else started


def _wheels(prefix: Path) -> Ros | None:
    if not _has(prefix, "rclpy"):
        return None
    return Ros(
        kind="wheels",
        version=_of_wheel(prefix) or _version(prefix),
        prefix=prefix,
        prefixes=(prefix,),
        python=prefix / "bin" / "python3",
        python_path=(),
        library_path=(prefix / "lib", *sorted((prefix / PYTHON_LIB).glob("ros_*.libs"))),
    )


def _of_wheel(prefix: Path) -> str:
    """Return the version of the wheel of rclpy, or "". importlib.metadata would find it, but imports 40 modules."""
    found = (prefix / PYTHON_LIB).glob("ros_rclpy-*.dist-info")
    return max((each.stem.removeprefix("ros_rclpy-") for each in found), default="")


def _has(prefix: Path, package: str) -> bool:
    return (prefix / "share/ament_index/resource_index/packages" / package).is_file()


def has_turtlesim(ros: Ros) -> bool:
    """Return whether this ROS 2 includes turtlesim, so that the turtlesim interfaces need not be built."""
    return any(_has(prefix, "turtlesim") for prefix in ros.prefixes)


def _version(prefix: Path) -> str:
    text = (prefix / "share/rclpy/package.xml").read_text(encoding="utf-8")
    match = re.search(r"<version>\s*([^<\s]+)", text)
    return match.group(1) if match else "of unknown version"
