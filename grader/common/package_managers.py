"""Package managers: their names for the packages that the course needs, and their commands.

Like machine.py, this module runs under any Python from 3.6 on, before anything is installed, so it uses only the syntax
of Python 3.6.
"""

import os
import re
import shutil
from pathlib import Path
from typing import FrozenSet, Iterable, List, Mapping, NamedTuple, Optional, Sequence, Tuple

SYSTEM_PATH = ("/usr/local/sbin", "/usr/local/bin", "/usr/sbin", "/usr/bin", "/sbin", "/bin")
OS_RELEASE = Path("/etc/os-release")
PACMAN_LISTS = Path("/var/lib/pacman/sync")
"""The package lists of pacman. This folder is empty in a fresh container."""


class Need(NamedTuple):
    """Something that the system lacks, and the Debian or Ubuntu package that provides it."""

    what: str
    package: str
    lost: str = ""
    """What does not work without this package. Empty if the package is required."""


class Manager(NamedTuple):
    """A package manager. The commands are shell lines, and `quiet` contains options for unattended use."""

    program: str
    systems: Tuple[str, ...]
    """The values of ID and ID_LIKE in /etc/os-release on the systems that use this package manager."""
    update: str
    install: str
    quiet: str
    names: Mapping[str, str]
    """Maps Debian's name for a package to this package manager's name for it, if the two names differ."""
    python: str = ""
    """A pattern for the name of the package that contains a Python with venv. The version is written as 3.12 (`dotted`)
    or 312 (`joined`)."""
    headers: str = ""
    newer: str = ""
    """Debian's name for the package of a newer Python, which is installed if the default Python is too old."""

    def packages(self, needs: Iterable[Need]) -> List[str]:
        """Return this package manager's names for the packages that are needed."""
        names = (self._name(need.package) for need in needs)
        return list(dict.fromkeys(name for name in names if name))

    def _name(self, package: str) -> str:
        found = re.match(r"(python3(?:\.\d+)?)(-venv|-dev)?$", package)
        if not found or not self.python:
            return self.names.get(package, package)
        python, part = found.groups()
        if part == "-venv":
            return ""
        version = python[len("python") :]
        pattern = self.headers if part else self.python
        return pattern.format(dotted=version, joined=version.replace(".", ""))


MANAGERS = (
    Manager(
        program="apt-get",
        systems=("debian", "ubuntu"),
        update="apt-get update",
        install="apt-get install -y",
        # Set a limit on how long to wait for a mirror that does not respond or for another installation.
        quiet="-q --no-install-recommends -o DPkg::Lock::Timeout=60 -o Acquire::http::Timeout=20",
        names={},
    ),
    Manager(
        program="dnf",
        systems=("fedora", "rhel", "centos"),
        update="",
        install="dnf install -y",
        quiet="-q --setopt=install_weak_deps=False",
        names={"g++": "gcc-c++", "shellcheck": "ShellCheck", "chromium-headless-shell": "chromium"},
        python="python{dotted}",
        headers="python{dotted}-devel",
        newer="python3.12",
    ),
    Manager(
        program="pacman",
        systems=("arch",),
        update="",
        install="pacman -S --needed --noconfirm",
        quiet="",
        names={
            "g++": "gcc",
            "chromium-headless-shell": "chromium",
            "python3-numpy": "python-numpy",
            "python3-empy": "python-empy",
            "python3-lark": "python-lark-parser",
        },
        python="python",
        headers="python",
    ),
    Manager(
        program="zypper",
        systems=("suse", "opensuse"),
        update="",
        install="zypper --non-interactive install",
        quiet="--no-recommends",
        names={"g++": "gcc-c++", "shellcheck": "ShellCheck", "chromium-headless-shell": "chromium"},
        python="python{joined}",
        headers="python{joined}-devel",
        newer="python3.11",
    ),
)


def find_manager(path: str) -> Optional[Manager]:
    """Return the package manager of this system, or None if it is unknown.

    If several package managers are installed, prefer the usual one for this system.
    """
    found = [manager for manager in MANAGERS if find_program(manager.program, path)]
    if len(found) > 1:
        own = _systems()
        found.sort(key=lambda manager: not own.intersection(manager.systems))
    return found[0] if found else None


def find_program(name: str, path: str) -> Optional[str]:
    """Return the path of a program, or None. Folders such as /sbin are searched in addition to `path`."""
    return shutil.which(name, path=os.pathsep.join([path, *SYSTEM_PATH]))


def command(manager: Optional[Manager], needs: Sequence[Need], *, root: bool) -> str:
    """Return the command line that installs the missing packages. If the manager is unknown, list Debian's names."""
    if manager is None:
        return "your package manager (Debian's names: {})".format(", ".join(dict.fromkeys(n.package for n in needs)))
    sudo = "" if root else "sudo "
    steps = [*([manager.update] if manager.update else []), " ".join([_install(manager), *manager.packages(needs)])]
    return " && ".join(sudo + step for step in steps)


def script(manager: Manager, groups: Sequence[Sequence[Need]]) -> str:
    """Return shell lines that install each group separately, so that a missing package affects only its own group."""
    lines = ["export LC_ALL=C DEBIAN_FRONTEND=noninteractive", *([manager.update + " -q"] if manager.update else [])]
    for group in groups:
        words = [_install(manager), manager.quiet, *manager.packages(group)]
        lines.append(" ".join(filter(None, words)) + " || failed=1")
    return "; ".join([*lines, "exit ${failed:-0}"])


def _install(manager: Manager) -> str:
    # Arch warns against refreshing the lists without upgrading the system.
    if manager.program == "pacman" and not any(PACMAN_LISTS.glob("*.db")):
        return manager.install.replace("-S ", "-Sy ")
    return manager.install


def _systems() -> FrozenSet[str]:
    try:
        text = OS_RELEASE.read_text()
    except OSError:
        return frozenset()
    values = re.findall(r"^ID(?:_LIKE)?=(.*)$", text, re.MULTILINE)
    return frozenset(word for value in values for word in value.strip("\"'").split())
