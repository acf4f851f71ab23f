"""Files of root in the home of an ordinary user. The user of the tests stands for root."""

from __future__ import annotations

import os
import shlex
from typing import TYPE_CHECKING

import pytest

from grader.common import roots_files
from grader.common.roots_files import belongs_to_root

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Create a home folder whose files belong to the one who stands for root, and become another user."""
    root = os.getuid()
    monkeypatch.setattr(roots_files, "_ROOT", root)
    monkeypatch.setattr(os, "getuid", lambda: root + 1)
    monkeypatch.setenv("HOME", str(tmp_path))
    (tmp_path / "my ws/src").mkdir(parents=True)
    return tmp_path


@pytest.mark.parametrize("path", ["my ws", "my ws/src", "my ws/src/new/file"])
def test_the_command_names_the_first_folder_of_root_below_the_home(home: Path, path: str) -> None:
    said = belongs_to_root(home / path)
    command = shlex.split(said.partition("Type: ")[2])
    assert command == ["sudo", "chown", "-R", f"{os.getuid()}:{os.getgid()}", str(home / "my ws")]


def test_the_home_itself_and_files_elsewhere_are_not_to_be_changed(home: Path) -> None:
    assert belongs_to_root(home / "new") == ""
    assert belongs_to_root(home.parent / "new") == ""


def test_the_root_folder_is_nobodys_home(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The user database of a container may not contain the user."""
    monkeypatch.setenv("HOME", "/")
    assert belongs_to_root(home / "my ws") == ""


def test_for_root_and_for_ones_own_files_there_is_no_sentence(home: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(roots_files, "_ROOT", os.getuid() + 7)
    assert belongs_to_root(home / "my ws") == ""
    monkeypatch.setattr(roots_files, "_ROOT", os.getuid())
    assert belongs_to_root(home / "my ws") == ""
