from __future__ import annotations

import errno
import shutil
from pathlib import Path

import pytest

from grader.common.new_folder import new_folder
from grader.errors import MachineError, UsageError


def write(folder: Path, error: BaseException | None) -> None:
    (folder / "a/b").mkdir(parents=True)
    (folder / "a/b/c").touch()
    if error:
        raise error


def test_the_folder_is_created_with_its_content(tmp_path: Path) -> None:
    with new_folder(tmp_path / "above/new", mode=0o700):
        write(tmp_path / "above/new", None)
    assert (tmp_path / "above/new/a/b/c").is_file()
    assert (tmp_path / "above/new").stat().st_mode & 0o777 == 0o700


@pytest.mark.parametrize("error", [OSError(errno.ENOSPC, "full", "a/b/d"), KeyboardInterrupt(), UsageError("no")])
@pytest.mark.parametrize("was_there", [True, False])
def test_a_folder_that_could_not_be_completed_is_as_it_was_before(
    tmp_path: Path, error: BaseException, *, was_there: bool
) -> None:
    folder = tmp_path / "new"
    if was_there:
        folder.mkdir()
    expected = MachineError if isinstance(error, OSError) else type(error)
    with pytest.raises(expected), new_folder(folder):
        write(folder, error)
    assert folder.exists() == was_there
    assert not was_there or not list(folder.iterdir())


def test_the_message_has_the_path_and_the_reason(tmp_path: Path) -> None:
    with pytest.raises(MachineError, match=r"^a/b/d could not be written: full\.$"), new_folder(tmp_path / "new"):
        write(tmp_path / "new", OSError(errno.ENOSPC, "full", "a/b/d"))


def test_a_folder_that_could_not_be_removed_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Path, "rmdir", lambda _: (_ for _ in ()).throw(OSError(errno.EPERM, "no")))
    with pytest.raises(MachineError, match=r"Remove .*/new before you try again\.$"), new_folder(tmp_path / "new"):
        write(tmp_path / "new", OSError(errno.ENOSPC, "full", "a/b/d"))


def test_an_empty_folder_that_could_not_be_emptied_again_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shutil, "rmtree", lambda *_, **__: None)
    (tmp_path / "new").mkdir()
    with pytest.raises(MachineError, match=r"Remove .*/new before you try again\.$"), new_folder(tmp_path / "new"):
        write(tmp_path / "new", OSError(errno.ENOSPC, "full", "a/b/d"))


@pytest.mark.parametrize("content", ["file", "folder"])
def test_a_folder_with_content_is_not_touched(tmp_path: Path, content: str) -> None:
    place = tmp_path / "new"
    if content == "folder":
        place.mkdir()
    (place / "mine" if content == "folder" else place).write_text("mine")
    with pytest.raises(UsageError, match="is not an empty folder"), new_folder(place):
        pass
    assert (place / "mine" if content == "folder" else place).read_text() == "mine"
