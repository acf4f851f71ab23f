"""`colcon build` typed in a folder of the course must not run code that belongs in the sandbox."""

from __future__ import annotations

import itertools
import shutil
import subprocess
import sys
from pathlib import Path, PurePosixPath

import pytest

from grader.authoring.handout import hand_out
from grader.checks.exercises import find_exercise
from grader.evidence.evidence import Evidence
from grader.evidence.recording_format import save
from grader.exercise.model import catalogue
from grader.gradebook.new_class import make_class
from grader.submission.package import open_submission
from grader.submission.search import IGNORE_MARKER, PACKAGE_FILES
from grader.tests.waiting import LONG_S

ROOT = Path(__file__).resolve().parents[2]
COLCON = Path(sys.executable).with_name("colcon")
STEP = "03-circle-publisher"
PACKAGE = ROOT / "solutions" / STEP / "my_robot_controller"
SUBMISSIONS = ("bases", "cases", "hostile", "mistakes", "unusual")
STEPS = [name for name in catalogue() if find_exercise(name).package]
BROKEN = "exercises", "04-package-files"
"""The package that the learner repairs. colcon cannot read it before that."""
PACKAGES = [pair for pair in itertools.product(("exercises", "solutions"), STEPS) if pair != BROKEN]


def colcon_list(folder: Path) -> list[str]:
    """Return the folders of the packages that colcon finds from `folder`.

    If colcon prints a message, the test fails.
    """
    done = subprocess.run(
        [COLCON, "--log-base", "/dev/null", "list", "--paths-only"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=True,
        timeout=LONG_S,
    )
    assert done.stderr == ""
    return done.stdout.splitlines()


def marker_maker(folder: Path) -> Path:
    """Create a submission in `folder` whose setup.py creates a file.

    Return the path of the file that setup.py creates.
    """
    shutil.copytree(PACKAGE, folder / "my_robot_controller", dirs_exist_ok=True)
    trace = folder / "setup.py was run"
    setup = folder / "my_robot_controller/setup.py"
    setup.write_text(f"open({str(trace)!r}, 'w')\n" + setup.read_text())
    return trace


@pytest.fixture(scope="module")
def tracked() -> list[PurePosixPath]:
    done = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        pytest.skip("not a git checkout")
    return [PurePosixPath(path) for path in done.stdout.split("\0") if path]


def test_no_package_of_a_test_can_be_found_by_colcon(tracked: list[PurePosixPath]) -> None:
    """Check the marker files without colcon, which would run every setup.py, even those that attack the machine."""
    packages = {path.parent for path in tracked if path.name in PACKAGE_FILES and path.is_relative_to("grader/tests")}
    assert len(packages) > 100
    above = {folder for package in packages for folder in package.parents if folder.is_relative_to("grader/tests")}
    ignored = {folder for folder in above if (ROOT / folder / IGNORE_MARKER).is_file()}
    assert ignored == {PurePosixPath("grader/tests"), *(PurePosixPath("grader/tests") / each for each in SUBMISSIONS)}
    assert {package for package in packages if ignored.isdisjoint(package.parents)} == set()


@pytest.mark.parametrize("folder", [".", "grader/tests", *(f"grader/tests/{name}" for name in SUBMISSIONS)])
def test_colcon_finds_nothing_in_the_course_folder_and_in_its_tests(folder: str) -> None:
    assert (ROOT / folder / IGNORE_MARKER).is_file(), "without it, colcon would run hostile code here"
    assert colcon_list(ROOT / folder) == []


@pytest.mark.parametrize(("side", "step"), PACKAGES)
def test_colcon_finds_the_package_of_a_step_in_its_folder(side: str, step: str) -> None:
    assert colcon_list(ROOT / side / step) == ["my_robot_controller"]


def test_nothing_that_is_copied_to_students_hides_their_package(tracked: list[PurePosixPath]) -> None:
    markers = [path.parent for path in tracked if path.name == IGNORE_MARKER]
    assert [path for path in markers if path.parts[:1] in {("exercises",), ("solutions",), ("course",)}] == []


def test_a_workspace_that_holds_the_course_has_no_package_twice(tmp_path: Path) -> None:
    """colcon builds only the learner's own package if the course is cloned into src/."""
    shutil.copytree(PACKAGE, tmp_path / "src/my_robot_controller")
    hand_out(tmp_path / "src/course")
    assert colcon_list(tmp_path) == ["src/my_robot_controller"]
    assert colcon_list(tmp_path / "src/course/exercises" / STEP) == ["my_robot_controller"]


def test_a_class_is_not_run_by_colcon(tmp_path: Path) -> None:
    make_class(tmp_path / "class-of-2027", None)
    trace = marker_maker(tmp_path / "class-of-2027/class/submitted/ada" / STEP)
    assert colcon_list(tmp_path) == []
    assert not trace.exists()


def test_a_recording_is_not_run_by_colcon(tmp_path: Path) -> None:
    trace = marker_maker(tmp_path / "given")
    submission = open_submission(tmp_path / "given/my_robot_controller")
    shutil.rmtree(tmp_path / "given/my_robot_controller")
    save(tmp_path / "recording", Evidence(find_exercise(STEP), submission), "none", ())
    assert (tmp_path / "recording/source/my_robot_controller/setup.py").is_file()
    assert colcon_list(tmp_path) == []
    assert not trace.exists()
