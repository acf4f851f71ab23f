"""What is installed, read from the ament index of every prefix on AMENT_PREFIX_PATH: packages, executables, types.

Only files are read, so that verbs about them need no rclpy.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from grader.ros.failure import Ros2Error, did_you_mean

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

_INDEX = Path("share/ament_index/resource_index")
KINDS = ("msg", "srv", "action")


def prefixes() -> list[Path]:
    """The folders on AMENT_PREFIX_PATH that are there: overlays first."""
    return [path for path in map(Path, os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)) if path.is_dir()]


def _resources(kind: str) -> dict[str, Path]:
    """Name of each package with a resource of this kind, with its prefix; sorted, the first prefix counts."""
    found: dict[str, Path] = {}
    for prefix in prefixes():
        for file in _entries(prefix / _INDEX / kind):
            found.setdefault(file.name, prefix)
    return dict(sorted(found.items()))


def packages() -> dict[str, Path]:
    """Name and prefix of each package, sorted by name."""
    return _resources("packages")


def prefix_of(package: str, unknown: str, likely: Iterable[str] = ()) -> Path:
    """The prefix of a package.

    Raises:
        Ros2Error: with the text `unknown`, and the nearest name of those that are `likely`, else of all.
    """
    found = packages()
    if package not in found:
        raise Ros2Error(did_you_mean(package, likely or found, unknown))
    return found[package]


def executables(package: str, unknown: str) -> list[Path]:
    """The executables of a package, in the order of their paths: what `ros2 run` can start.

    Raises:
        Ros2Error: there is no such package, in the words of `unknown`.
    """
    folder = prefix_of(package, unknown) / "lib" / package
    return sorted(path for path in _walk(folder) if path.is_file() and os.access(path, os.X_OK))


def interface_packages() -> dict[str, Path]:
    """Name and prefix of each package that has messages, services or actions."""
    return _resources("rosidl_interfaces")


def interfaces(package: str) -> list[str]:
    """The interfaces of one package, sorted: "geometry_msgs/msg/Twist"; none for a package without interfaces.

    Raises:
        Ros2Error: there is no such package.
    """
    found = interface_packages()
    if package not in found:
        prefix_of(package, f"Unknown package '{package}'", found)
        return []
    lines = (found[package] / _INDEX / "rosidl_interfaces" / package).read_text("utf-8").split()
    files = (Path(line) for line in lines)
    return sorted(f"{package}/{file.parent}/{file.stem}" for file in files if file.suffix[1:] in KINDS)


def all_interfaces(kind: str | None = None) -> list[str]:
    """The interfaces of all packages, of one kind ("msg", "srv" or "action") if it is given."""
    found = (name for package in interface_packages() for name in interfaces(package))
    return [name for name in found if kind in (None, name.split("/")[1])]


def interface_file(name: str) -> Path:
    """The file that defines an interface: "geometry_msgs/msg/Twist" -> .../geometry_msgs/msg/Twist.msg.

    Raises:
        Ros2Error: there is none of this name.
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
        # The name alone is compared: what is equal in all of them must not make them alike.
        known = interfaces(parts[0]) if parts[0] in interface_packages() else []
        ends = {candidate.rsplit("/", 1)[1]: candidate for candidate in known}
        hint = did_you_mean(parts[2], ends).replace("Did you mean '", f"Did you mean '{parts[0]}/{parts[1]}/")
        message = f"Could not find the interface '{found.with_suffix('.idl')}'"
        raise Ros2Error(f"{message}\n{hint}" if hint else message)
    return found


def _meant(name: str) -> list[str]:
    """What a name that is too short may mean: "Twist", "geometry_msgs/Twist" -> "geometry_msgs/msg/Twist"."""
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
