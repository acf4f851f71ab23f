"""Install what the system lacks, as root or by sudo; where that cannot be had, say why.

Runs under any Python 3 before anything is installed, as machine.py does: syntax of Python 3.6.
"""

import os
import re
import subprocess
import sys
from typing import Callable, List, Mapping, Optional, Sequence

from grader.common import packages

TOLD_LINES = 3
"""How much of what a package manager says is repeated when it fails."""
_ERROR = re.compile(r"(E:|W:|Err:|error|problem|fatal|no package|nothing provides|sudo:)", re.IGNORECASE)


def provide(needs: Sequence[packages.Need], env: Mapping[str, str], say: Callable[[str], None]) -> str:
    """Install what is needed, with a line to `say` beforehand; return why not all of it could be.

    What cannot be done without goes first, and anything else by itself, so that one package that the system does not
    have stops no other.
    """
    path = env.get("PATH", "")
    manager = packages.find_manager(path)
    if env.get("INSTALL_SYSTEM") == "0":
        return "INSTALL_SYSTEM=0 leaves the system as it is"
    if manager is None:
        return "no package manager that the set-up knows is here"
    groups = _groups(needs)
    rights = _rights(path)
    if rights is None:
        return "only root can install it, and sudo is not here"
    script = packages.script(manager, groups)
    command = packages.command(manager, needs, root=os.getuid() == 0)
    if rights[-1:] == ["-n"] and not _quietly(rights):
        if not _at_terminal():
            return "only root can install it, and sudo needs a password, for which there is no terminal"
        rights = rights[:-1]
        say("The system lacks some programs. sudo asks for your password to install them (INSTALL_SYSTEM=0 does not):")
        print(f"    sudo sh -c '{script}'", flush=True)
    else:
        say(f"Installing what the system lacks: {command}")
    return _run([*rights, "sh", "-c", script], manager.program, env)


def _groups(needs: Sequence[packages.Need]) -> List[List[packages.Need]]:
    """All that cannot be done without in one group, each other need in one of its own."""
    musts = [need for need in needs if not need.lost]
    return [*([musts] if musts else []), *([need] for need in needs if need.lost)]


def _rights(path: str) -> Optional[List[str]]:
    """Return what a command is started by to be root's; None if it cannot be."""
    if os.getuid() == 0:
        return []
    sudo = packages.find_program("sudo", path)
    return [sudo, "-n"] if sudo else None


def _quietly(rights: Sequence[str]) -> bool:
    """Tell whether sudo asks for nothing."""
    return subprocess.call([*rights, "true"], stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL) == 0


def _at_terminal() -> bool:
    return sys.stdin.isatty() and sys.stdout.isatty()


def _run(command: Sequence[str], program: str, env: Mapping[str, str]) -> str:
    """Run a package manager; return what went wrong in its own words."""
    try:
        # sudo asks at the terminal itself, whatever these are.
        done = subprocess.run(
            command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=env
        )
    except OSError as error:
        return f"{command[0]} could not be started: {error.strerror}"
    if done.returncode == 0:
        return ""
    lines = [line.strip() for line in done.stdout.decode("utf-8", "replace").splitlines()]
    told = [line for line in lines if _ERROR.match(line)] or list(filter(None, lines))[-1:]
    words = "; ".join(line.rstrip(".?") for line in list(dict.fromkeys(told))[:TOLD_LINES])
    return f"{program} failed: {words or 'it gave no reason'}"
