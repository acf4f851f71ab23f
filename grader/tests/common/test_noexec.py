"""If a file system is mounted with the option noexec, a message contains its path and says what to do."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from grader.common import noexec
from grader.tests.pretended import mounted_noexec

if TYPE_CHECKING:
    import pytest


def test_the_mount_is_named_even_if_the_path_does_not_exist(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mounted = tmp_path / "stick"
    (mounted / "course").mkdir(parents=True)
    mounted_noexec(monkeypatch, mounted)
    assert noexec.noexec_folder(mounted / "course/new/.venv") == mounted
    assert noexec.noexec_folder(tmp_path / "new/.venv") is None


def test_the_sentence_has_both_remedies() -> None:
    said = noexec.noexec_sentence(Path("/media/a stick"), "use another folder")
    assert said == (
        "/media/a stick is mounted with the option noexec, so the system runs no programs from there: use another "
        "folder, or allow programs with: sudo mount -o remount,exec '/media/a stick'"
    )
