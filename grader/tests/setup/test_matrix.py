"""The real set-up in a fresh clone: with each Python, as an ordinary user, on a small disk, and after interruptions."""

from __future__ import annotations

import os
import shutil
import signal
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.setup import machine
from grader.tests.setup.fresh import Clone, clone
from grader.tests.setup.test_refusing_machine import MB, SEES, on_a_disk

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = [pytest.mark.exhaustive, pytest.mark.door]
PASSED = "Passed: 100 of 100 points."
MINORS = range(machine.OLDEST[1], machine.NEWEST[1] + 1)
ORDINARY = 54321
"""The user id of a user that the system does not have."""
STAGES = (
    "Creating .venv",
    "Installing the installer",
    "Installing ROS 2 Jazzy",
    "Installed ",
    "Bytecode compiled",
    "Set up:",
    "$ grader check",
)
"""The lines that the set-up prints at the beginning or end of a stage."""


def pythons() -> dict[int, str]:
    """Return each suitable Python on this machine by its minor version, from the system and from pyenv."""
    versions = sorted(Path.home().glob(".pyenv/versions/*/bin"))
    path = os.pathsep.join([*machine.SYSTEM_PATH, os.environ.get("PATH", ""), *map(str, versions)])
    fit = (python for python in machine.find_pythons(path) if python.cpython and python.venv and python.headers)
    found: dict[int, str] = {}
    for python in fit:
        found.setdefault(python.version[1], python.path)
    return found


@pytest.mark.parametrize("minor", MINORS)
def test_each_python(tmp_path: Path, minor: int) -> None:
    here = pythons()
    if minor not in here:
        pytest.skip(f"Python 3.{minor} with headers is not installed")
    said = clone(tmp_path).run(f"make demo PYTHON={here[minor]}")
    assert f"Creating .venv with Python 3.{minor}." in said
    assert PASSED in said


@pytest.fixture
def ordinary(tmp_path: Path) -> Iterator[Clone]:
    """Create a clone that belongs to an ordinary user, without any file of root."""
    if os.getuid() != 0:
        yield clone(tmp_path)
        return
    place = Path(tempfile.mkdtemp(prefix="ordinary user "))
    place.chmod(0o755)
    course = clone(place)
    settings = Path.home() / ".config/pip/pip.conf"
    if settings.is_file():
        shutil.copyfile(settings, course.home / "pip.conf")
    own = {"PIP_CONFIG_FILE": "pip.conf", "PIP_CACHE_DIR": ".cache/pip", "UV_CACHE_DIR": ".cache/uv"}
    for folder, _, files in os.walk(place):
        for name in (".", *files):
            os.chown(Path(folder, name), ORDINARY, ORDINARY)
    yield replace(
        course,
        within=("setpriv", f"--reuid={ORDINARY}", f"--regid={ORDINARY}", "--clear-groups"),
        settings=tuple((name, str(course.home / path)) for name, path in own.items()),
    )
    shutil.rmtree(place)


def test_an_ordinary_user(ordinary: Clone) -> None:
    assert PASSED in ordinary.make("demo")
    ordinary.run("source .venv/setup.bash && grader start 01 && cp -r solutions/01-first-node/. ~/ros2_ws/src/")
    assert PASSED in ordinary.run("source .venv/setup.bash && grader check")


def test_a_home_that_cannot_be_written_to(tmp_path: Path) -> None:
    course = clone(tmp_path)
    place = tmp_path / "elsewhere"
    course.folder.rename(place)
    empty = (("UV_CACHE_DIR", str(course.home / "uv")), ("PIP_CACHE_DIR", str(course.home / "pip")))
    within = (*SEES, "--ro-bind", str(course.home), str(course.home))
    course = replace(course, folder=place, within=within, settings=empty)
    said = course.run("make demo", ends=2)
    assert "XDG_CACHE_HOME" in said
    assert "Traceback" not in said
    assert PASSED in course.run("make demo", XDG_CACHE_HOME=str(tmp_path / "cache"))


@pytest.mark.parametrize("room", [120 * MB, 250 * MB, 450 * MB])
def test_a_disk_that_becomes_full_and_has_room_again(tmp_path: Path, room: int) -> None:
    course = on_a_disk(clone(tmp_path), 1500 * MB)
    fill = f"fallocate -l {1500 * MB - room} filler"
    said = course.run(f"{fill} && ! make demo && rm filler && make demo")
    first, _, second = said.partition("Error 3")
    assert "The disk is full for " in first
    assert "Traceback" not in said
    assert PASSED in second


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_stopped_at_every_stage_and_run_again(tmp_path: Path, number: signal.Signals) -> None:
    course = clone(tmp_path)
    for stage in STAGES:
        said = course.stop("make demo", stage, number)
        assert "Traceback" not in said
        if stage == "Installing the installer" and number == signal.SIGINT:
            assert "Stopped. The same command continues from here" in said
    assert PASSED in course.make("demo")
