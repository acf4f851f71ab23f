"""The installed packages, executables and types, as read from the ament index of each prefix on AMENT_PREFIX_PATH.

This module only reads files, so the verbs that use it do not need rclpy.
"""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common.words import printable
from grader.ros.failure import Ros2Error, did_you_mean, similar

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

_INDEX = Path("share/ament_index/resource_index")
KINDS = ("msg", "srv", "action")
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")


def prefixes() -> list[Path]:
    """Return the folders on AMENT_PREFIX_PATH that exist, overlays first."""
    entries = filter(None, os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep))
    return [path for path in map(Path, entries) if path.is_dir()]


def _resources(kind: str) -> dict[str, Path]:
    """Return the packages that have a resource of this kind, with the first prefix of each, sorted by name."""
    found: dict[str, Path] = {}
    for prefix in prefixes():
        for file in _entries(prefix / _INDEX / kind):
            found.setdefault(file.name, prefix)
    return dict(sorted(found.items()))


def packages() -> dict[str, Path]:
    """Return the names and prefixes of all packages, sorted by name."""
    return _resources("packages")


def has_package(name: str) -> bool:
    """Return whether the package is installed."""
    return any((prefix / _INDEX / "packages" / name).exists() for prefix in prefixes())


def contents(kind: str) -> dict[str, list[str]]:
    """Return the lines of each package's resource of this kind, for example "rclcpp_components", by package name."""
    return {
        name: (prefix / _INDEX / kind / name).read_text("utf-8", "replace").splitlines()
        for name, prefix in _resources(kind).items()
    }


def prefix_of(package: str, unknown: str, likely: Iterable[str] = ()) -> Path:
    """Return the first prefix on AMENT_PREFIX_PATH that contains the package.

    Raises:
        Ros2Error: the package is not installed. The message is `unknown`, followed by the most similar name if one
        is similar enough. The names are those in `likely`, or those of all packages if `likely` is empty.
    """
    found = packages()
    if package not in found:
        raise Ros2Error(did_you_mean(package, likely or found, unknown))
    return found[package]


def executables(package: str, unknown: str) -> list[Path]:
    """Return the executables in a package that `ros2 run` can start, sorted by path.

    Raises:
        Ros2Error: the package is not installed. The message is the same as from `prefix_of`.
    """
    return executables_in(prefix_of(package, unknown) / "lib" / package)


def executables_in(folder: Path) -> list[Path]:
    """Return the executable files in the folder and in its subfolders, sorted by path."""
    return sorted(path for path in _walk(folder) if path.is_file() and os.access(path, os.X_OK))


def interface_packages() -> dict[str, Path]:
    """Return the names and prefixes of all packages that have messages, services or actions."""
    return _resources("rosidl_interfaces")


def interfaces(package: str) -> list[str]:
    """Return the sorted interfaces of a package, for example "geometry_msgs/msg/Twist". The list may be empty.

    Raises:
        Ros2Error: the package is not installed.
    """
    found = interface_packages()
    if package not in found:
        prefix_of(package, f"Unknown package '{package}'", found)
        return []
    lines = (found[package] / _INDEX / "rosidl_interfaces" / package).read_text("utf-8").split()
    files = (Path(line) for line in lines)
    return sorted(f"{package}/{file.parent}/{file.stem}" for file in files if file.suffix[1:] in KINDS)


def all_interfaces(kind: str | None = None) -> list[str]:
    """Return the interfaces of all packages, or only the interfaces of one kind ("msg", "srv" or "action")."""
    found = (name for package in interface_packages() for name in interfaces(package))
    return [name for name in found if kind in (None, name.split("/")[1])]


def has_interface(package: str, kind: str, name: str) -> bool:
    """Return whether the interface is installed. `name` may also be that of a part, such as SetPen_Request.

    The names may come from another program: any string that is not a name of ROS 2 is not installed.
    """
    if not (_NAME.fullmatch(package) and _NAME.fullmatch(name)):
        return False
    file = name.partition("_")[0]
    folders = [prefix / "share" / package / kind for prefix in prefixes()]
    return any((folder / f"{file}.{ending}").is_file() for folder in folders for ending in (kind, "idl"))


def interface_file(name: str) -> Path:
    """Return the file that defines an interface: .../geometry_msgs/msg/Twist.msg for "geometry_msgs/msg/Twist".

    Raises:
        Ros2Error: no installed interface has this name.
    """
    parts = name.split("/")
    if not all(parts):
        message = f"Invalid name '{name}'. Must not contain empty parts"
        raise Ros2Error(message)
    if len(parts) != 3 or ".." in parts:
        text = f"Invalid name '{name}'. Expected three parts separated by '/'"
        raise Ros2Error(did_you_mean(name, _meant(name), text))
    prefix = prefix_of(parts[0], f"Unknown package '{parts[0]}'", interface_packages())
    found = prefix / "share" / parts[0] / parts[1] / f"{parts[2]}.{parts[1]}"
    if not found.is_file():
        # Compare only the last part of the name: the package is the same in all candidates, and the kind may be wrong.
        known = interfaces(parts[0]) if parts[0] in interface_packages() else []
        ends = {candidate.rsplit("/", 1)[1]: candidate for candidate in known}
        last = parts[2] if parts[2] in ends else similar(parts[2], ends)
        message = f"Could not find the interface '{found.with_suffix('.idl')}'"
        raise Ros2Error(f"{message}\nDid you mean '{printable(ends[last])}'?" if last else message)
    return found


def _meant(name: str) -> list[str]:
    """Return the full names (such as "geometry_msgs/msg/Twist") for a short name: "Twist" or "geometry_msgs/Twist".

    If no interface has this name, return the names of all interfaces.
    """
    package, _, last = name.rpartition("/")
    found = [full for full in all_interfaces() if full.endswith(f"/{last}") and full.startswith(package)]
    return found or all_interfaces()


def _entries(folder: Path) -> Iterator[Path]:
    try:
        yield from (path for path in folder.iterdir() if not path.name.startswith("."))
    except OSError:
        return


def _walk(folder: Path) -> Iterator[Path]:
    for path in sorted(_entries(folder)):
        if path.is_dir() and not path.is_symlink():
            yield from _walk(path)
        else:
            yield path
