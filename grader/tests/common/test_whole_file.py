"""A file is complete, or it is what it was before."""

from __future__ import annotations

import os
import signal
import stat
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from grader.common.whole_file import write_whole

if TYPE_CHECKING:
    from pathlib import Path

IS_KILLED = """
import os, signal, sys
from pathlib import Path
from grader.common.whole_file import write_whole
os.fsync = lambda _: os.kill(os.getpid(), signal.SIGKILL)
write_whole(Path(sys.argv[1]), b"new")
"""


def test_a_file_is_created_and_replaced(tmp_path: Path) -> None:
    file = tmp_path / "grades.csv"
    for content, mode in ((b"old", 0o640), (b"new", 0o755)):
        write_whole(file, content, mode=mode)
        assert (file.read_bytes(), stat.S_IMODE(file.stat().st_mode)) == (content, mode)
    assert list(tmp_path.iterdir()) == [file]


def test_without_a_mode_the_permissions_are_those_of_any_new_file(tmp_path: Path) -> None:
    for file in (tmp_path / "one", tmp_path / "other"):
        (write_whole(file, b"") if file.name == "one" else file.touch())
    assert (tmp_path / "one").stat().st_mode == (tmp_path / "other").stat().st_mode


def test_a_full_disk_leaves_the_old_file_and_no_part_of_the_new_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "grades.csv"
    write_whole(file, b"old")

    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        write_whole(file, b"new")
    assert [(each.name, each.read_bytes()) for each in tmp_path.iterdir()] == [("grades.csv", b"old")]


def test_a_kill_leaves_the_old_file_and_the_next_write_removes_the_part(tmp_path: Path) -> None:
    file = tmp_path / "grades.csv"
    write_whole(file, b"old")
    done = subprocess.run([sys.executable, "-c", IS_KILLED, file], check=False)
    assert (done.returncode, file.read_bytes()) == (-signal.SIGKILL, b"old")
    assert {each.name for each in tmp_path.iterdir()} == {"grades.csv", ".grades.csv.partial"}
    write_whole(file, b"new")
    assert (file.read_bytes(), len(list(tmp_path.iterdir()))) == (b"new", 1)
