"""Other users cannot prepare the files that the grader opens in the folder for temporary files."""

from __future__ import annotations

import errno
import os
import tempfile
from contextlib import ExitStack
from pathlib import Path

import pytest

from grader.common.private_folder import private_folder
from grader.errors import DiskError, MachineError
from grader.trial.own_domain import own_domain

NAME = f"ros2-grader-{os.getuid()}"


def link(at: Path) -> None:
    (at.parent / "elsewhere").mkdir()
    at.symlink_to("elsewhere")


def of_everybody(at: Path) -> None:
    at.mkdir()
    at.chmod(0o777)


def of_another_user(at: Path) -> None:
    if os.geteuid() != 0:
        pytest.skip("only root can give a folder to another user")
    at.mkdir(mode=0o700)
    os.chown(at, 61_001, 61_001)


@pytest.mark.parametrize("prepare", [link, of_everybody, of_another_user, Path.touch])
def test_a_folder_that_another_user_has_prepared_is_refused(tmp_path: Path, prepare: object) -> None:
    assert callable(prepare)
    prepare(tmp_path / NAME)
    with pytest.raises(MachineError, match="only you can open"):
        private_folder(tmp_path, NAME)


def test_a_full_disk_is_reported_as_such(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "mkdir", full)
    with pytest.raises(DiskError, match="No space left on device"):
        private_folder(tmp_path, NAME)


def test_it_is_the_same_for_each_process_of_a_user(tmp_path: Path) -> None:
    assert private_folder(tmp_path, NAME) == private_folder(tmp_path, NAME) == tmp_path / NAME
    assert (tmp_path / NAME).stat().st_mode & 0o777 == 0o700


def test_a_lock_in_the_shared_folder_overwrites_no_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Another user guesses the name of the lock file, and creates a link with this name to a file of this user."""
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    mine = tmp_path / "mine.txt"
    mine.write_text("my work")
    for domain in range(1, 102):
        (tmp_path / f"grader-domain-{os.getuid()}-{domain}.lock").symlink_to(mine)
        (tmp_path / f"domain-{domain}.lock").symlink_to(mine)
    with ExitStack() as stack:
        assert own_domain(stack) != own_domain(stack)
    assert mine.read_text() == "my work"
