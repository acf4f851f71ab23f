from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.common import xdg

if TYPE_CHECKING:
    from collections.abc import Callable

FOLDERS = [(xdg.cache, "XDG_CACHE_HOME", ".cache"), (xdg.state, "XDG_STATE_HOME", ".local/state")]


@pytest.fixture(autouse=True)
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("HOME", str(tmp_path))
    for _, variable, _ in FOLDERS:
        monkeypatch.delenv(variable, raising=False)
    return tmp_path


@pytest.mark.parametrize(("folder", "variable"), [each[:2] for each in FOLDERS])
def test_it_is_below_the_folder_that_the_variable_names(
    monkeypatch: pytest.MonkeyPatch, folder: Callable[[], Path], variable: str
) -> None:
    monkeypatch.setenv(variable, "/else where")
    assert folder() == Path("/else where/grader")


@pytest.mark.parametrize("value", [None, "", "relative", "./here", "~/there"])
@pytest.mark.parametrize(("folder", "variable", "default"), FOLDERS)
def test_a_variable_that_names_no_absolute_path_counts_as_none(
    home: Path,
    monkeypatch: pytest.MonkeyPatch,
    folder: Callable[[], Path],
    variable: str,
    default: str,
    value: str | None,
) -> None:
    if value is not None:
        monkeypatch.setenv(variable, value)
    assert folder() == home / default / "grader"


@pytest.mark.parametrize(("folder", "variable"), [each[:2] for each in FOLDERS])
def test_a_path_with_two_dots_is_resolved(
    monkeypatch: pytest.MonkeyPatch, home: Path, folder: Callable[[], Path], variable: str
) -> None:
    monkeypatch.setenv(variable, f"{home}/a/../b")
    assert folder() == home / "b/grader"


def test_a_user_without_a_name_has_an_id(monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a container that runs as a user id of the host."""
    for variable in ("LOGNAME", "USER", "LNAME", "USERNAME"):
        monkeypatch.delenv(variable, raising=False)
    monkeypatch.setattr(os, "getuid", lambda: 54321)
    assert xdg.user_name() == "54321"
    monkeypatch.setenv("USER", "ada")
    assert xdg.user_name() == "ada"
