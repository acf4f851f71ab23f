from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from grader.setup import bootstrap
from grader.setup.place import place_problem
from grader.setup.setup_errors import MACHINE_BROKEN
from grader.tests.pretended import mounted_noexec

ROOT = Path(bootstrap.__file__).parents[2]


@pytest.mark.parametrize("name", ["ros2 course", "übung", "don't", "a_b-c.d", "50%", "(1)", "a&b", "x{y}", "a+b=c,d@e"])
def test_most_paths_are_fine(name: str) -> None:
    assert place_problem(Path("/home/ada", name)) == ""


@pytest.mark.parametrize("sign", ':;"\\#?[]|$`\n\t')
def test_a_path_with_which_a_program_fails_is_named(sign: str) -> None:
    problem = place_problem(Path(f"/home/ada/ros{sign}course"))
    assert "Rename or move the folder" in problem
    assert problem.isprintable()


def test_a_path_that_is_not_unicode_is_named() -> None:
    assert "\\udcfc" in place_problem(Path(os.fsdecode(b"/home/ada/\xfcbung")))


def test_a_folder_from_which_no_program_runs_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mounted_noexec(monkeypatch, tmp_path)
    problem = place_problem(tmp_path / "course")
    assert problem.startswith(f"{tmp_path} is mounted with the option noexec")
    assert "copy the course's folder to another file system" in problem


def test_the_set_up_says_so_before_it_does_anything(tmp_path: Path) -> None:
    place = tmp_path / "ros:course"
    place.mkdir()
    for name in ("grader", "requirements.lock", "Makefile", "pyproject.toml"):
        (place / name).symlink_to(ROOT / name)
    code = f"from pathlib import Path; from grader.setup import bootstrap; bootstrap.ROOT = Path({str(place)!r}); "
    code += "import sys; sys.exit(bootstrap.main(['learner']))"
    done = subprocess.run(["python3", "-c", code], cwd=ROOT, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr.count("\n")) == (MACHINE_BROKEN, 1)
    assert "contains ':'" in done.stderr
    assert not (place / ".venv").exists()
