"""A fresh clone of the course, with nothing installed.

Each `make` target is run in a separate clone, and one real task is done with the result. These tests need the network
if packages are missing from the caches of pip and uv. `.ci/doors` and `make test-all` run the tests that use such
clones.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

ROOT = Path(__file__).parents[3]
SET_UP_S = 900
"""The time limit of a command (s). With full caches, every command takes less than a minute."""
NETWORK = ("PIP_", "UV_", "SSL_CERT_", "HTTP_PROXY", "HTTPS_PROXY", "ALL_PROXY", "NO_PROXY")
"""The variables that this machine needs to download packages. A fresh clone gets no other variables of the
environment."""


@dataclass(frozen=True)
class Clone:
    """A clone of the course, and the home folder of its user."""

    folder: Path
    home: Path
    within: tuple[str, ...] = ()
    """A prefix of each command, for another user or another view of the disks."""
    settings: tuple[tuple[str, str], ...] = ()
    """Additional environment variables."""

    def run(self, command: str, *, ends: int = 0, cwd: Path | None = None, **environment: str) -> str:
        """Run a line of bash. Return its output.

        Raises:
            AssertionError: the exit code is not `ends`.
        """
        started = self._start(command, cwd or self.folder, environment)
        try:
            printed, _ = started.communicate(timeout=SET_UP_S)
        finally:
            if started.poll() is None:
                os.killpg(started.pid, signal.SIGKILL)
                started.wait()
        assert started.returncode == ends, f"{command}: {started.returncode}\n{printed}"
        return printed

    def _start(self, command: str, folder: Path, environment: Mapping[str, str]) -> subprocess.Popen[str]:
        # A shell script ignores SIGINT in its background jobs, such as `.ci/doors &`, and a child inherits that.
        # A signal with a handler has its default effect in a child.
        inherited = signal.signal(signal.SIGINT, signal.default_int_handler)
        try:
            return subprocess.Popen(
                [*self.within, "bash", "-c", f'cd "$0" && {command}', str(folder)],
                cwd="/",
                env={**self.environment(), **environment},
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                text=True,
                errors="replace",
            )
        finally:
            signal.signal(signal.SIGINT, inherited)

    def stop(self, command: str, at: str, number: signal.Signals) -> str:
        """Run a command. When the command prints `at`, send the signal to it and to all its children.

        Return its output.

        Raises:
            AssertionError: the command ended without printing `at`.
        """
        started = self._start(command, self.folder, {})
        with started:
            printed = ""
            for line in started.stdout or ():
                printed += line
                if at in line:
                    os.killpg(started.pid, number)
                    break
            else:
                raise AssertionError(printed)
            return printed + (started.stdout.read() if started.stdout else "")

    def make(self, target: str) -> str:
        """Run the target, and check that the installed packages are compatible. Return the output."""
        said = self.run(f"make {target}")
        self.run(".venv/bin/uv pip check --python .venv/bin/python")
        return said

    def lacks(self, module: str) -> bool:
        """Return whether the Python of the clone lacks a module."""
        return "No module named" in self.run(f".venv/bin/python -c 'import {module}'", ends=1)

    def environment(self) -> dict[str, str]:
        """Return an almost empty environment, as with `env -i`. Earlier downloads are used again."""
        network = {name: value for name, value in os.environ.items() if name.upper().startswith(NETWORK)}
        cache = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
        settings = Path.home() / ".config/pip/pip.conf"
        return {
            **({"PIP_CONFIG_FILE": str(settings)} if settings.is_file() else {}),
            "PIP_CACHE_DIR": str(cache / "pip"),
            "UV_CACHE_DIR": str(cache / "uv"),
            **network,
            "HOME": str(self.home),
            **dict(self.settings),
        }


def clone(folder: Path) -> Clone:
    """Copy the current state of all files that git does not ignore into a home folder below `folder`.

    The path of the clone has spaces.
    """
    home = folder / "home of Ada"
    target = home / "ros2 course"
    listed = subprocess.run(
        ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        cwd=ROOT, capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    for name in filter(None, listed.split("\0")):
        if (ROOT / name).is_file():  # skip a file that was removed without a commit
            (target / name).parent.mkdir(parents=True, exist_ok=True)
            with suppress(FileNotFoundError):  # another process has removed it meanwhile
                shutil.copy2(ROOT / name, target / name)
    return Clone(target, home)
