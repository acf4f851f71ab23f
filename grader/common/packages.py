"""The system's package manager: the names that it has for what the course needs, and the command that installs it.

Runs under any Python 3 before anything is installed, as machine.py does: syntax of Python 3.6.
"""

import os
import re
import shutil
from pathlib import Path
from typing import FrozenSet, Iterable, List, Mapping, NamedTuple, Optional, Sequence, Tuple

SYSTEM_PATH = ("/usr/local/sbin", "/usr/local/bin", "/usr/sbin", "/usr/bin", "/sbin", "/bin")
OS_RELEASE = Path("/etc/os-release")
PACMAN_LISTS = Path("/var/lib/pacman/sync")
"""Empty in a fresh container."""


class Need(NamedTuple):
    """Something that the system lacks, and the Debian or Ubuntu package that brings it."""

    what: str
    package: str
    lost: str = ""
    """What does not work without it; empty where nothing does."""


class Manager(NamedTuple):
    """A package manager. Its commands are lines of a shell; `quiet` adds the options for where nobody answers."""

    program: str
    systems: Tuple[str, ...]
    """What its systems call themselves in /etc/os-release: ID and ID_LIKE."""
    update: str
    install: str
    quiet: str
    names: Mapping[str, str]
    """Its names by Debian's, where they differ."""
    python: str = ""
    """Its name of a Python, in terms of its version as 3.12 (`dotted`) or 312 (`joined`); that has the module venv."""
    headers: str = ""
    newer: str = ""
    """A Python that it has beside a default that is too old, by Debian's name."""

    def packages(self, needs: Iterable[Need]) -> List[str]:
        """Return its names for what is needed."""
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
        # A mirror that does not answer, or another installation under way, is waited for, but not for ever.
        quiet="-q --no-install-recommends -o DPkg::Lock::Timeout=60 -o Acquire::http::Timeout=20",
        names={},
    ),
    Manager(
        program="dnf",
        systems=("fedora", "rhel", "centos"),
        update="",
        install="dnf install -y",
        quiet="-q --setopt=install_weak_deps=False",
        names={"g++": "gcc-c++", "shellcheck": "ShellCheck"},
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
        names={"g++": "gcc-c++", "shellcheck": "ShellCheck"},
        python="python{joined}",
        headers="python{joined}-devel",
        newer="python3.11",
    ),
)


def find_manager(path: str) -> Optional[Manager]:
    """Return the package manager of this system; where several are installed, the one its kind of system lives by."""
    here = [manager for manager in MANAGERS if find_program(manager.program, path)]
    if len(here) > 1:
        own = _systems()
        here.sort(key=lambda manager: not own.intersection(manager.systems))
    return here[0] if here else None


def find_program(name: str, path: str) -> Optional[str]:
    """Return where a program of the system is; an administrator's folders are searched too."""
    return shutil.which(name, path=os.pathsep.join([path, *SYSTEM_PATH]))


def command(manager: Optional[Manager], needs: Sequence[Need], *, root: bool) -> str:
    """Return the line to type that installs what is missing; Debian's names of it where no manager is known."""
    if manager is None:
        return "your package manager (Debian's names: {})".format(", ".join(dict.fromkeys(n.package for n in needs)))
    sudo = "" if root else "sudo "
    steps = [*([manager.update] if manager.update else []), " ".join([_install(manager), *manager.packages(needs)])]
    return " && ".join(sudo + step for step in steps)


def script(manager: Manager, groups: Sequence[Sequence[Need]]) -> str:
    """Return the lines of a shell that install each group by itself: one that cannot be had stops no other."""
    lines = ["export LC_ALL=C DEBIAN_FRONTEND=noninteractive", *([manager.update + " -q"] if manager.update else [])]
    for group in groups:
        words = [_install(manager), manager.quiet, *manager.packages(group)]
        lines.append(" ".join(filter(None, words)) + " || failed=1")
    return "; ".join([*lines, "exit ${failed:-0}"])


def _install(manager: Manager) -> str:
    # To refresh the lists alone, with an old system below, is what Arch warns of.
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
