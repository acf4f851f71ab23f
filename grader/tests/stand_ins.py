"""Fake programs that only record their calls, in place of programs that would change this machine."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path


@dataclass(frozen=True)
class StandIns:
    """A folder for PATH. Each line of the file `calls` is one call: the program's name and its arguments."""

    folder: Path

    @property
    def path(self) -> str:
        """Return a PATH with only the fake programs. Their scripts add the folders of the real programs."""
        return str(self.folder)

    def add(self, name: str, then: str = "") -> None:
        """Add a program.

        When the program runs, it executes the shell code in `then`, with the real programs on PATH.
        """
        self.folder.mkdir(parents=True, exist_ok=True)
        program = self.folder / name
        note = f'echo "{name} $*" >> "{self.folder}/calls"'
        program.write_text(f'#!/bin/sh\n{note}\nPATH="$PATH:/usr/bin:/bin"\n{then}\n')
        program.chmod(0o755)

    def calls(self) -> list[str]:
        """Return the recorded calls."""
        file = self.folder / "calls"
        return file.read_text("utf-8").splitlines() if file.exists() else []
