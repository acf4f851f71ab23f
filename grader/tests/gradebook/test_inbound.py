"""Folders in nbgrader's exchange that claim to belong to another student."""

from __future__ import annotations

import os
import pwd
from typing import TYPE_CHECKING

import pytest

from grader.gradebook.inbound import why_not

if TYPE_CHECKING:
    from pathlib import Path

ANNA, BEN = 61_001, 61_002


@pytest.fixture
def accounts(monkeypatch: pytest.MonkeyPatch) -> None:
    ids = {"anna": ANNA, "ben": BEN}

    def of_name(name: str) -> pwd.struct_passwd:
        return pwd.struct_passwd((name, "x", ids[name], ids[name], "", "/", "/bin/sh"))

    monkeypatch.setattr(pwd, "getpwnam", of_name)


@pytest.mark.usefixtures("accounts")
@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give a folder to another user")
@pytest.mark.parametrize(
    ("student", "owner", "refused"),
    [("anna", ANNA, False), ("anna", BEN, True), ("anna", 0, False), ("without an account", BEN, False)],
)
def test_a_folder_of_another_account_is_not_a_students_submission(
    tmp_path: Path, student: str, owner: int, refused: bool
) -> None:
    folder = tmp_path / f"{student}+step+now"
    folder.mkdir()
    os.chown(folder, owner, owner)
    assert why_not(folder, student, owned=True) == (
        f"it does not belong to {student}, but to the user {owner}" if refused else ""
    )
    assert why_not(folder, student, owned=False) == ""


@pytest.mark.parametrize("student", ["*", "ann?", "[ab]nna"])
def test_a_name_that_is_a_pattern_is_not_collected(tmp_path: Path, student: str) -> None:
    folder = tmp_path / f"{student}+step+now"
    folder.mkdir()
    assert "as a pattern for the names of other students" in why_not(folder, student, owned=False)
