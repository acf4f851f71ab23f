"""The digest of the files of which a set-up is made: if one of them changes, the set-up must run again."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from grader.setup import bootstrap

if TYPE_CHECKING:
    from pathlib import Path

HASHED = (
    *("requirements.lock", "grader/setup/numpy.txt", "grader/setup/pytest.txt", "pyproject.toml"),
    "grader/setup/commands/grader",
)


@pytest.mark.parametrize("changed", HASHED)
def test_a_change_of_a_copied_file_needs_the_set_up_again(
    changed: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An editable installation copies the commands: after an update of the course, old commands would stay."""
    for name in HASHED:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("old\n", "utf-8")
    monkeypatch.setattr(bootstrap, "ROOT", tmp_path)
    before = bootstrap.digest()
    assert bootstrap.digest() == before
    (tmp_path / changed).write_text("new\n", "utf-8")
    assert bootstrap.digest() != before


def test_the_copied_files_are_those_of_the_project() -> None:
    text = (bootstrap.ROOT / "pyproject.toml").read_text("utf-8")
    copied = re.findall(r'^"(grader/[^"]+)" = "', text, re.MULTILINE)
    assert copied
    for name in copied:
        assert any(name == each or name.startswith(f"{each}/") for each in bootstrap.COPIED)
