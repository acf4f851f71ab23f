"""The real set-up on a machine without network, permission or space prints one message and no traceback."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.setup.setup_errors import MACHINE_BROKEN
from grader.tests.setup.fresh import Clone, clone

if TYPE_CHECKING:
    from pathlib import Path

MB = 10**6
SEES = ("bwrap", "--dev-bind", "/", "/")
NOTHING_KEPT = (("PIP_CACHE_DIR", "/nowhere/pip"), ("UV_CACHE_DIR", "/nowhere/uv"))


def refused(course: Clone, said: str, end: str = ".") -> None:
    """Check that `make demo` ends with one message that contains `said`, and ends with `end`."""
    printed = course.run("make demo", ends=2)  # make exits with 2 if a command fails
    assert f"Error {MACHINE_BROKEN}" in printed
    (sentence,) = [line for line in printed.splitlines() if said in line]
    assert sentence.endswith(end)
    assert "Traceback" not in printed


def test_without_a_network(tmp_path: Path) -> None:
    course = replace(clone(tmp_path), within=(*SEES, "--unshare-net"), settings=NOTHING_KEPT)
    refused(course, "This machine cannot reach the Python packages")


def test_in_a_folder_that_cannot_be_written_to(tmp_path: Path) -> None:
    course = clone(tmp_path)
    there = str(course.folder)
    refused(replace(course, within=(*SEES, "--ro-bind", there, there)), ".venv cannot be written to (Read-only")


def test_on_a_disk_that_is_mounted_noexec(tmp_path: Path) -> None:
    course = clone(tmp_path)
    alone = ("unshare", "--mount", *(() if os.getuid() == 0 else ("--map-root-user",)))
    mount = 'mount --bind "$0" "$0" && mount -o remount,bind,noexec "$0" && exec "$@"'
    within = (*alone, "sh", "-c", mount, str(course.folder))
    refused(replace(course, within=within), f"{course.folder} is mounted with the option noexec", end="'")


@pytest.mark.parametrize("room", [24 * MB, pytest.param(60 * MB, marks=[pytest.mark.exhaustive, pytest.mark.door])])
def test_on_a_full_disk(tmp_path: Path, room: int) -> None:
    course = on_a_disk(clone(tmp_path), room)
    refused(course, f"The disk is full for {course.folder}/.venv: free some space there")


def on_a_disk(course: Clone, room: int) -> Clone:
    """Return the clone on a separate disk with this much space (bytes). Each command gets a new disk."""
    original = course.folder.with_name("original")
    course.folder.rename(original)
    course.folder.mkdir()
    copy = f'cp -r "{original}/." "{course.folder}" && exec "$@"'
    within = (*SEES, "--size", str(room), "--tmpfs", str(course.folder), "bash", "-c", copy, "copy")
    return replace(course, within=within)
