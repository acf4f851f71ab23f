"""Install programs that the system lacks, as root or with sudo, or return why this is not possible.

Like machine.py, this module runs under any Python from 3.6 on, before anything is installed, so it uses only the syntax
of Python 3.6.
"""

import os
import re
import subprocess
import sys
from typing import Callable, List, Mapping, Optional, Sequence

from grader.common import package_managers

TOLD_LINES = 3
"""The number of lines to show from a failed package manager's output."""
_ERROR = re.compile(r"(E:|W:|Err:|error|problem|fatal|no package|nothing provides|sudo:)", re.IGNORECASE)


def provide(needs: Sequence[package_managers.Need], env: Mapping[str, str], say: Callable[[str], None]) -> str:
    """Install the packages that are needed, if this is allowed. Before that, print a line with `say`.

    Return the reason why something could not be installed, or an empty string if everything was installed.

    The required packages are installed first, in one command. Each optional package is installed separately, so that a
    missing package does not prevent the installation of other packages.
    """
    path = env.get("PATH", "")
    manager = package_managers.find_manager(path)
    if env.get("INSTALL_SYSTEM") == "0":
        return "INSTALL_SYSTEM=0 forbids changes to the system"
    if manager is None:
        return "the set-up does not support the package manager of this system"
    groups = _groups(needs)
    rights = _rights(path)
    if rights is None:
        return "only root can install programs, and sudo is not installed"
    script = package_managers.script(manager, groups)
    command = package_managers.command(manager, needs, root=os.getuid() == 0)
    if rights[-1:] == ["-n"] and not _quietly(rights):
        if not _at_terminal():
            return "only root can install programs, and sudo needs a terminal to ask for a password"
        rights = rights[:-1]
        say("The system lacks some programs. sudo asks for your password to install them (unless INSTALL_SYSTEM=0):")
        print(f"    sudo sh -c '{script}'", flush=True)
    else:
        say(f"Installing the missing system packages: {command}")
    return _run([*rights, "sh", "-c", script], manager.program, env)


def _groups(needs: Sequence[package_managers.Need]) -> List[List[package_managers.Need]]:
    """Return the needed packages in groups: all required packages together, and each optional package separately."""
    musts = [need for need in needs if not need.lost]
    return [*([musts] if musts else []), *([need] for need in needs if need.lost)]


def _rights(path: str) -> Optional[List[str]]:
    """Return the prefix of a command that needs root: empty for root, otherwise sudo, or None if there is no sudo."""
    if os.getuid() == 0:
        return []
    sudo = package_managers.find_program("sudo", path)
    return [sudo, "-n"] if sudo else None


def _quietly(rights: Sequence[str]) -> bool:
    """Return whether sudo works without a password."""
    return subprocess.call([*rights, "true"], stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL) == 0


def _at_terminal() -> bool:
    return sys.stdin.isatty() and sys.stdout.isatty()


def _run(command: Sequence[str], program: str, env: Mapping[str, str]) -> str:
    """Run a package manager. Return the error message, or an empty string if the package manager succeeded."""
    try:
        # sudo opens the terminal for the password, so redirecting these streams does not affect the prompt.
        done = subprocess.run(
            command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=env
        )
    except OSError as error:
        return f"{command[0]} could not be started: {error.strerror}"
    if done.returncode == 0:
        return ""
    lines = [line.strip() for line in done.stdout.decode("utf-8", "replace").splitlines()]
    reported = [line for line in lines if _ERROR.match(line)] or list(filter(None, lines))[-1:]
    words = "; ".join(line.rstrip(".?") for line in list(dict.fromkeys(reported))[:TOLD_LINES])
    return f"{program} failed: {words or 'no reason given'}"
