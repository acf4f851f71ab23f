"""A copy of the course that has not been set up."""

from __future__ import annotations

import os
import subprocess
from typing import TYPE_CHECKING, Any

import pytest

from grader.setup import bootstrap, machine

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

from grader.tests.setup.course import Course


@pytest.fixture
def course(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Course:
    course = Course(tmp_path)
    (tmp_path / "requirements.lock").write_text("one")
    (tmp_path / "pyproject.toml").write_text("two")
    for name, value in {
        "ROOT": tmp_path,
        "VENV": tmp_path / ".venv",
        "PYTHON": tmp_path / ".venv/bin/python3",
        "STAMP": course.stamp,
    }.items():
        monkeypatch.setattr(bootstrap, name, value)
    monkeypatch.setattr(bootstrap, "read_stamp", _bind(bootstrap.read_stamp, course.stamp))
    monkeypatch.setattr(subprocess, "call", course.call)
    monkeypatch.setattr(subprocess, "check_output", course.call)
    monkeypatch.setattr(os, "getuid", lambda: 1000)
    monkeypatch.setattr(bootstrap, "provide", course.provide)
    monkeypatch.setattr(machine, "probe", lambda _path: course.python)
    monkeypatch.setattr(machine, "find_pythons", lambda _path: iter([course.python]))
    monkeypatch.setattr(machine, "for_ros", lambda python, _ros: python)
    monkeypatch.setattr(machine, "missing_tools", lambda _path, _ros: list(course.needs))
    monkeypatch.setattr(machine, "is_offline", lambda _env: course.offline)
    monkeypatch.setattr(machine, "missing_of_tests", lambda _path: list(course.of_tests))
    return course


def _bind(function: Callable[[Path], Any], path: Path) -> Callable[[], Any]:
    return lambda: function(path)
