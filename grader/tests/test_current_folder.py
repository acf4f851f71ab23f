"""Commands that are typed in a folder full of traps run nothing from this folder, and report the correct points."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.classroom.gradescope_archive import TEMPLATES
from grader.ros import installation, underlay
from grader.sandbox import bubblewrap
from grader.tests.both_worlds import REAL_ROS2
from grader.tests.case import ROOT, copy_solution
from grader.tests.classroom.a_class import reports
from grader.tests.traps import Traps, careless

if TYPE_CHECKING:
    from collections.abc import Iterator

STEP = "03-circle-publisher"
pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="the sandbox is not available")


class Folder:
    """The current folder: a solution and a starting point among the traps. The results are outside this folder."""

    def __init__(self, folder: Path) -> None:
        self.here, self.out = folder / "clone", folder / "out"
        self.out.mkdir()
        self.traps = Traps(self.here, folder / "touched")
        copy_solution(STEP, self.here / "package")
        copy_solution(STEP, self.here / "class" / "anna")
        shutil.copytree(ROOT / "exercises" / STEP, self.here / "class" / "ben")
        self.env = {**careless(), "HOME": str(folder / "home"), "XDG_CACHE_HOME": str(folder / "cache")}

    def run(self, *command: object, code: int = 0, cwd: Path | None = None, **env: str) -> str:
        """Run a command in the folder. Check the exit code, and that the command touched no trap. Return its output."""
        done = subprocess.run(
            [*map(str, command)],
            cwd=cwd or self.here,
            env={**self.env, **env},
            capture_output=True,
            text=True,
            check=False,
            stdin=subprocess.DEVNULL,
            timeout=900,
        )
        assert (self.traps.touched, done.returncode) == ([], code), done.stdout + done.stderr
        return done.stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Folder]:
    made = Folder(tmp_path_factory.mktemp("folder"))
    kept = underlay.ensure(installation.find_ros())
    if kept is not None:
        shutil.copytree(kept, Path(made.env["XDG_CACHE_HOME"], "grader", kept.name), symlinks=True)
    yield made
    assert made.traps.touched == []


def points(out: Path) -> dict[str, float]:
    """Map each student of a graded class to the student's points."""
    return {student: float(report["points"]) for student, report in reports(out).items()}


def test_the_traps_are_traps(tmp_path: Path) -> None:
    traps = Traps(tmp_path / "here", tmp_path / "touched")
    command = [sys.executable, "-c", "import importlib.metadata as m; [e.load() for e in m.entry_points(name='trap')]"]
    subprocess.run(command, cwd=traps.folder, check=False, capture_output=True)
    # If Python has imported importlib when it starts, the traps replace the modules that importlib imports later.
    assert {"importlib", "email"} & set(traps.touched)
    plain = [sys.executable, "-c", "import grader, numpy"]
    subprocess.run(plain, cwd=traps.folder, check=False)
    subprocess.run(["cmake"], cwd=traps.folder, check=False, env={"PATH": ":/usr/bin:/bin"})
    assert {"grader", "numpy", "program cmake"} <= set(traps.touched)


def test_a_package_is_checked(folder: Folder) -> None:
    report = folder.out / "report.json"
    wanted = ("--json", report, "--html", folder.out / "page.html", "--image", folder.out / "picture.png")
    folder.run("grader", "check", "--sandbox", "package", "--exercise", STEP, *wanted)
    assert json.loads(report.read_text())["points"] == 100.0


def test_a_package_is_checked_without_a_sandbox_and_regraded(folder: Folder) -> None:
    folder.run("grader", "check", "package", "--exercise", STEP, "--recording", folder.out / "recording")
    assert "100 of 100" in folder.run("grader", "regrade", folder.out / "recording")


def test_a_class_is_graded(folder: Folder) -> None:
    folder.run("grader", "grade", "class", "--exercise", STEP, "--out", folder.out / "grades")
    graded = points(folder.out / "grades")
    assert (graded["anna"], graded["ben"] < 50.0) == (100.0, True)
    folder.run("grader", "class-page", folder.out / "grades" / "reports", "--out", folder.out / "class.html")


def test_the_script_of_the_templates_grades(folder: Folder) -> None:
    folder.run(TEMPLATES / "grade.sh", "class/ben", "ben", STEP, folder.out / "one", "--fail-under", "60", code=1)
    assert points(folder.out / "one")["ben"] < 50.0


def test_commands_that_look_around(folder: Folder) -> None:
    folder.run("grader", "doctor")
    folder.run("grader", "env")
    folder.run("ros2", "pkg", "list")
    # The real ros2 starts its daemon with `python -c`, which searches the current folder for modules.
    folder.run("ros2", "topic", "list", *(["--no-daemon"] if REAL_ROS2 else []))
    folder.run("rqt_graph", "--text", code=1)


def test_a_gradebook_is_synced(folder: Folder, tmp_path: Path) -> None:
    pytest.importorskip("nbgrader")
    folder.run("grader", "class", "new", tmp_path / "term")
    submitted = tmp_path / "term" / "class" / "submitted"
    shutil.copytree(ROOT / "exercises" / STEP, submitted / "anna" / STEP)
    copy_solution(STEP, submitted / "anna" / STEP / "my_robot_controller")
    folder.run("nbgrader", "generate_assignment", STEP, cwd=tmp_path / "term" / "course", PYTHONPATH="")
    folder.run("grader", "gradebook", "sync", STEP, "--course", tmp_path / "term" / "course")
    assert points(tmp_path / "term" / "class" / "results") == {"anna": 100.0}
