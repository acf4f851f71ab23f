"""Which ROS 2 is here, and the environment that child processes need for it.

A sourced ROS 2 Jazzy is used where there is one, else the wheels of this Python's own environment. The grader's
own process never imports rclpy: all of ROS 2 lives in child processes with the environment made here.
"""

from __future__ import annotations

import os
import re
import sys
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from grader.errors import MachineError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

DISTRO = "jazzy"
FASTDDS_PROFILE = Path(__file__).with_name("fastdds.xml")
_PYTHON_LIB = Path(f"lib/python{sys.version_info.major}.{sys.version_info.minor}/site-packages")


@dataclass(frozen=True)
class Ros:
    """A ROS 2 installation; every list is in the order of search."""

    kind: Literal["sourced", "wheels"]
    version: str
    """The version of rclpy."""
    prefix: Path
    """The ament prefix that holds rclpy: like /opt/ros/jazzy."""
    prefixes: tuple[Path, ...]
    python: Path
    python_path: tuple[Path, ...]
    library_path: tuple[Path, ...]

    @property
    def name(self) -> str:
        """As a report tells it; nothing of the machine's paths beyond what `source` names."""
        return f"Jazzy (rclpy {self.version}, {'sourced' if self.kind == 'sourced' else 'wheels'})"


def find_ros(env: Mapping[str, str] = os.environ) -> Ros:
    """The ROS 2 Jazzy to use: the sourced one, else the wheels beside this Python.

    Raises:
        MachineError: neither is here.
    """
    ros = _sourced(env) or _wheels(Path(sys.prefix))
    if ros is None:
        seen = env.get("ROS_DISTRO")
        found = f"ROS 2 {seen.capitalize()} is sourced, and no" if seen and seen != DISTRO else "No"
        message = (
            f"{found} ROS 2 Jazzy was found. Run `make demo` in the course's folder, which installs it into .venv, "
            "and `source .venv/bin/activate`; or source your own: `source /opt/ros/jazzy/setup.bash`."
        )
        raise MachineError(message)
    return ros


def environment(
    ros: Ros, *, home: Path, underlay: Path | None = None, overlays: Sequence[Path] = (), domain: int = 0
) -> dict[str, str]:
    """The whole environment of a child process: nothing of the caller's leaks in.

    `underlay` is the prefix of the turtlesim interfaces, `overlays` are install folders of packages
    (install/<package>), searched first. `home` must be writable: HOME, ROS_LOG_DIR and TMPDIR lie there.
    """
    local = [*overlays, *([underlay] if underlay else [])]
    env = {
        "PATH": os.pathsep.join([str(ros.python.parent), "/usr/local/bin", "/usr/bin", "/bin"]),
        "HOME": str(home),
        "LANG": "C.UTF-8",
        "PYTHONNOUSERSITE": "1",
        # Same order of sets and dictionaries in every run: the same submission, the same report.
        "PYTHONHASHSEED": "0",
        # A line printed is a line seen, as on a terminal.
        "PYTHONUNBUFFERED": "1",
        "ROS_DISTRO": DISTRO,
        "ROS_VERSION": "2",
        "ROS_PYTHON_VERSION": "3",
        "ROS_LOG_DIR": str(home / "log"),
        "ROS_DOMAIN_ID": str(domain),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "RCUTILS_COLORIZED_OUTPUT": "0",
        "AMENT_PREFIX_PATH": os.pathsep.join(map(str, [*local, *ros.prefixes])),
        "CMAKE_PREFIX_PATH": os.pathsep.join(map(str, [*local, *ros.prefixes])),
        "LD_LIBRARY_PATH": os.pathsep.join(map(str, [*(p / "lib" for p in local), *ros.library_path])),
        "PYTHONPATH": os.pathsep.join(map(str, [*(p / _PYTHON_LIB for p in local), *ros.python_path])),
        # The wheels' .pth would start every interpreter a second time, and mix their libraries with a sourced ROS.
        "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1",
        # `msg.linear.x = 2` is one clear error instead of garbage on the wire.
        "ROS_PYTHON_CHECK_FIELDS": "1",
        # Shared memory would need a common /dev/shm, which a sandboxed node does not have.
        "FASTDDS_BUILTIN_TRANSPORTS": "UDPv4",
        "FASTRTPS_DEFAULT_PROFILES_FILE": str(FASTDDS_PROFILE),
        "RMW_IMPLEMENTATION": "rmw_fastrtps_cpp",
    }
    return {key: value for key, value in env.items() if value}


def users_environment(ros: Ros, underlay: Path | None, env: Mapping[str, str] = os.environ) -> dict[str, str]:
    """The environment of a node that a user starts for themselves: their own, and what ROS 2 needs on top.

    Home, domain, PATH and what else the user has set stay theirs, so that nodes of other terminals are heard.
    """
    home = Path(env.get("HOME", "/"))
    needed = environment(ros, home=home, underlay=underlay)
    theirs = {"HOME", "PATH", "LANG", "ROS_DOMAIN_ID", "ROS_AUTOMATIC_DISCOVERY_RANGE", "RMW_IMPLEMENTATION"}
    del needed["ROS_LOG_DIR"], needed["RCUTILS_COLORIZED_OUTPUT"], needed["PYTHONHASHSEED"]
    return {**needed, **{key: value for key, value in env.items() if key in theirs or key not in needed}}


def _sourced(env: Mapping[str, str]) -> Ros | None:
    if env.get("ROS_DISTRO") != DISTRO:
        return None
    searched = [Path(p) for p in env.get("AMENT_PREFIX_PATH", "").split(os.pathsep) if p]
    prefix = next((p for p in searched if _has(p, "rclpy") and p != Path(sys.prefix)), None)
    if prefix is None:
        return None

    # Only the installation's own entries: a student's sourced workspace must not shadow anything.
    def own(variable: str) -> tuple[Path, ...]:
        entries = [Path(p) for p in env.get(variable, "").split(os.pathsep) if p]
        return tuple(p for p in entries if p.is_relative_to(prefix))

    return Ros(
        kind="sourced",
        version=_version(prefix),
        prefix=prefix,
        prefixes=(prefix,),
        python=Path(sys.executable),
        python_path=own("PYTHONPATH"),
        library_path=own("LD_LIBRARY_PATH"),
    )


def _wheels(prefix: Path) -> Ros | None:
    if not _has(prefix, "rclpy"):
        return None
    return Ros(
        kind="wheels",
        version=metadata.version("ros-rclpy"),
        prefix=prefix,
        prefixes=(prefix,),
        python=prefix / "bin" / "python3",
        python_path=(),
        library_path=(prefix / "lib", *sorted((prefix / _PYTHON_LIB).glob("ros_*.libs"))),
    )


def _has(prefix: Path, package: str) -> bool:
    return (prefix / "share/ament_index/resource_index/packages" / package).is_file()


def has_turtlesim(ros: Ros) -> bool:
    """Whether this ROS 2 brings a turtlesim of its own, so that ours need not be built."""
    return any(_has(prefix, "turtlesim") for prefix in ros.prefixes)


def _version(prefix: Path) -> str:
    text = (prefix / "share/rclpy/package.xml").read_text(encoding="utf-8")
    match = re.search(r"<version>\s*([^<\s]+)", text)
    return match.group(1) if match else "of unknown version"
