"""The temporary folder of a process that was killed does not stay, and that of a running process is not removed."""

from __future__ import annotations

import multiprocessing
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from grader.common.private_folder import users_folder
from grader.common.temporary_folder import temporary_folder

USES_A_FOLDER = """
import sys
from grader.common.temporary_folder import temporary_folder
with temporary_folder() as folder:
    (folder / "submitted.py").write_text("secret")
    print(folder, flush=True)
    sys.stdin.read()
"""


@pytest.fixture(autouse=True)
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder for temporary files, also of child processes."""
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr(tempfile, "tempdir", None)
    return tmp_path


def folders() -> set[Path]:
    return {path for path in users_folder().iterdir() if path.is_dir()}


def process() -> tuple[subprocess.Popen[str], Path]:
    """Start a process that uses a temporary folder until its standard input ends."""
    child = subprocess.Popen(
        [sys.executable, "-c", USES_A_FOLDER], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )
    assert child.stdout is not None
    return child, Path(child.stdout.readline().strip())


def test_it_is_empty_private_and_removed_at_the_end() -> None:
    with temporary_folder() as folder, temporary_folder() as other:
        assert folders() == {folder, other}
        assert list(folder.iterdir()) == []
        assert folder.stat().st_mode & 0o777 == 0o700
        (folder / "closed").mkdir(mode=0o000)
    assert folders() == set()


def test_the_folder_of_a_killed_process_is_removed_and_that_of_a_running_process_is_not() -> None:
    killed, left = process()
    running, used = process()
    with killed, running:
        killed.kill()
        killed.wait()
        assert (left / "submitted.py").read_text() == "secret"
        with temporary_folder() as folder:
            assert folders() == {folder, used}
            assert (used / "submitted.py").read_text() == "secret"
        running.communicate()
    assert running.returncode == 0
    assert folders() == set()


def use_many(_: int) -> None:
    for _ in range(100):
        with temporary_folder() as folder:
            (folder / "file").touch()
            assert (folder / "file").exists()


def test_processes_that_start_and_end_together_keep_their_folders() -> None:
    with multiprocessing.get_context("fork").Pool(4) as pool:
        pool.map(use_many, range(4), chunksize=1)
    assert folders() == set()
