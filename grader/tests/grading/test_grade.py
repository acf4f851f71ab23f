"""Grade the solution with the real command: from a recording, on a broken machine, and many times in parallel."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from grader.tests.both_worlds import SOURCED_ENV, python_path

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).resolve().parents[3]
SOLUTION = ROOT / "solutions" / "03-circle-publisher"
COMPARED = ("id", "status", "points", "diagnosis", "cause")


def grader(*arguments: object, env: dict[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    command = [str(Path(sys.executable).with_name("grader")), *map(str, arguments)]
    return subprocess.run(
        command,
        capture_output=True,
        text=True,
        check=False,
        stdin=subprocess.DEVNULL,
        timeout=600,
        env={**os.environ, **(env or {})},
    )


def outcomes(report: Path) -> list[tuple[Any, ...]]:
    return [tuple(outcome[key] for key in COMPARED) for outcome in json.loads(report.read_text())["outcomes"]]


def graded(folder: Path, *options: object) -> list[tuple[Any, ...]]:
    report = folder / "report.json"
    done = grader("check", SOLUTION, "--json", report, *options)
    assert done.returncode == 0, done.stdout + done.stderr
    return outcomes(report)


@contextmanager
def busy(loops: int) -> Iterator[None]:
    children = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(loops)]
    try:
        yield
    finally:
        for child in children:
            child.kill()
            child.wait()


def test_a_recording_is_judged_again_without_running_anything(tmp_path: Path) -> None:
    kept = tmp_path / "kept"
    first = graded(tmp_path, "--recording", kept, "--seed", "5")
    again = grader("regrade", kept, "--json", tmp_path / "again.json", env={"PATH": "/nowhere"})
    assert again.returncode == 0, again.stdout + again.stderr
    assert outcomes(tmp_path / "again.json") == first
    report, regraded = (json.loads((tmp_path / name).read_text()) for name in ("report.json", "again.json"))
    for key in ("exercise", "submission", "clock", "seed", "points", "max", "ros"):
        assert regraded[key] == report[key], key


def test_a_recording_never_overwrites(tmp_path: Path) -> None:
    (tmp_path / "mine").write_text("mine")
    done = grader("check", SOLUTION, "--recording", tmp_path)
    assert done.returncode == 2
    assert "not an empty folder" in done.stderr
    assert [file.name for file in tmp_path.iterdir()] == ["mine"]


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        ("trials/circle/trial.json", "is not a recording from"),
        ("submission.json", "is not a recording from"),
        ("exercise/exercise.toml", "exercise.toml"),
        ("trials/circle/bag/bag.mcap", "is not a recording from"),
    ],
)
def test_a_damaged_recording_is_a_sentence(tmp_path: Path, recorded: Path, damage: str, said: str) -> None:
    copy = tmp_path / "copy"
    subprocess.run(["cp", "-r", recorded, copy], check=True)
    file = next(copy.glob(damage))
    file.write_bytes(file.read_bytes()[:40])
    done = grader("regrade", copy)
    assert done.returncode == 2, done.stdout + done.stderr
    assert said in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize(
    ("name", "said"), [("", "is not a recording: it has no submission.json"), ("none", "is not a folder")]
)
def test_a_folder_that_is_no_recording_is_reported(tmp_path: Path, name: str, said: str) -> None:
    done = grader("regrade", tmp_path / name)
    assert done.returncode == 2, done.stdout + done.stderr
    assert said in done.stderr
    assert "Give the folder that `grader check --recording` wrote." in done.stderr.replace("\n", " ")
    assert "Error" not in done.stderr


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("recorded") / "kept"
    assert grader("check", SOLUTION, "--recording", folder).returncode == 0
    return folder


LIMITED = """
import os, grader.sandbox.limits as limits
class Low:
    def __getattr__(self, name):
        return getattr(limits_of_system, name)
    def getrlimit(self, which):
        return ({limit}, {limit}) if which == self.{name} else limits_of_system.getrlimit(which)
limits_of_system, limits.resource, limits.os = limits.resource, Low(), type("", (), {{"geteuid": lambda: 54321}})
"""
"""A low limit of an ordinary user."""


def broken(tmp_path: Path, sitecustomize: str) -> subprocess.CompletedProcess[str]:
    """Grade on a machine with a fault, which the given sitecustomize.py causes in the grader's own process."""
    no_stored_build = "import grader.colcon.build_store as store\nstore.BuildStore.get = lambda *_: None\n"
    (tmp_path / "sitecustomize.py").write_text(no_stored_build + sitecustomize)
    return grader("check", SOLUTION, "--json", tmp_path / "report.json", env={"PYTHONPATH": python_path(tmp_path)})


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        (
            """
import grader.ros.installation
grader.ros.installation._wheels = grader.ros.installation._sourced = lambda _: None
""",
            "which is not sourced in this terminal" if SOURCED_ENV else "No ROS 2 Jazzy was found",
        ),
        (
            """
import grader.errors, grader.ros.underlay
def fail(*_): raise grader.errors.MachineError('There is no C++ compiler: install g++.')
grader.ros.underlay.ensure = fail
""",
            "There is no C++ compiler",
        ),
        (
            """
import grader.sandbox.bubblewrap
grader.sandbox.bubblewrap.usable = lambda: True
grader.sandbox.bubblewrap.cell = lambda *_, **__: ['sh', '-c', 'echo no namespaces >&2; exit 1']
""",
            "could not be started",
        ),
        (
            """
import grader.sandbox.bubblewrap
grader.sandbox.bubblewrap.usable = lambda: True
grader.sandbox.bubblewrap.room = lambda *_, **__: ['sh', '-c', 'echo no namespaces >&2; exit 1']
""",
            "grader doctor",
        ),
        (
            """
import pathlib, shutil, tempfile, grader.colcon.runner as runner
root = pathlib.Path(tempfile.mkdtemp())
copies = [root / path.relative_to(runner.IN_CELL.parents[2]) for path in (runner.IN_CELL, *runner.IMPORTED)]
for path, copy in zip((runner.IN_CELL, *runner.IMPORTED), copies):
    copy.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(path, copy)
future = "from __future__ import annotations\\n"
copies[0].write_text(copies[0].read_text().replace(future, future + "import sys; sys.modules['em'] = None\\n"))
runner.IN_CELL, *runner.IMPORTED = copies
""",
            "The build could not be started: ModuleNotFoundError",
        ),
        (LIMITED.format(name="RLIMIT_NPROC", limit=100), "This user may run at most 100 processes and threads"),
        (LIMITED.format(name="RLIMIT_AS", limit=2**30), "at most 1024 MiB of address space"),
    ],
    ids=["no ROS", "no compiler", "no cell", "no room", "no empy", "few processes", "little memory"],
)
def test_a_fault_of_the_machine_is_an_error_and_no_failure(tmp_path: Path, fault: str, said: str) -> None:
    done = broken(tmp_path, fault)
    assert done.returncode == 3, done.stdout + done.stderr
    assert said in done.stdout
    assert "Traceback" not in done.stdout + done.stderr
    report = json.loads((tmp_path / "report.json").read_text())
    statuses = {outcome["status"] for outcome in report["outcomes"]}
    assert "error" in statuses
    assert "failed" not in statuses
    assert report["max"] == 100.0
    judged = [outcome for outcome in report["outcomes"] if outcome["status"] == "passed"]
    assert report["points"] == sum(outcome["max"] for outcome in judged)


@pytest.mark.exhaustive
def test_fifty_gradings_under_load_have_the_same_report(tmp_path: Path) -> None:
    with busy(4):
        reports = [graded(tmp_path) for _ in range(50)]
    assert all(report == reports[0] for report in reports)


@pytest.mark.exhaustive
def test_ten_trials_at_once_discover_as_surely_as_one(tmp_path: Path) -> None:
    folders = [tmp_path / str(number) for number in range(10)]
    for folder in folders:
        folder.mkdir()
    with ThreadPoolExecutor(10) as pool:
        reports = list(pool.map(graded, folders))
    assert all(report == reports[0] for report in reports)
    clocks = {json.loads((folder / "report.json").read_text())["clock"]["used"] for folder in folders}
    assert clocks == {"simulated"}


@pytest.mark.exhaustive
@pytest.mark.parametrize("seed", [1, 2])
def test_the_solution_passes_from_another_start(tmp_path: Path, seed: int) -> None:
    assert {status for _, status, *_ in graded(tmp_path, "--seed", seed)} == {"passed"}
