"""Properties of a machine that a test pretends, since it may not change the machine."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pytest


def mounted_noexec(monkeypatch: pytest.MonkeyPatch, folder: Path) -> None:
    """Let `folder` look like a file system that is mounted with the option noexec, and no other folder."""
    real = os.statvfs

    def statvfs(path: str) -> os.statvfs_result:
        flags = os.ST_NOEXEC if Path(path).is_relative_to(folder) else 0
        found = real(path)
        return os.statvfs_result((*found[:8], flags, *found[9:]))

    monkeypatch.setattr(os, "statvfs", statvfs)
