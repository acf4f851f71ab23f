"""The templates: their script is run, and each file is valid for the system that uses it."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import jsonschema  # type: ignore[import-untyped]
import pytest
import yaml

from grader.classroom.archives import unpacked
from grader.classroom.gradescope_archive import TEMPLATES, build_archive
from grader.errors import UsageError
from grader.exercise.model import course_folder
from grader.sandbox import bubblewrap
from grader.tests.case import copy_solution
from grader.tests.classroom.a_class import STEP, environment
from grader.tests.lacking import give_up
from grader.tests.report.readers import RESULTS, commands

if TYPE_CHECKING:
    from collections.abc import Mapping

BIN = Path(sys.executable).parent
SCRIPT = TEMPLATES / "grade.sh"


def run(*argv: object, env: Mapping[str, str] = {}) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [*map(str, argv)],
        capture_output=True,
        text=True,
        check=False,
        stdin=subprocess.DEVNULL,
        timeout=600,
        env=environment(PATH=f"{BIN}:{os.environ['PATH']}", **env),
    )


def template(name: str) -> Any:  # noqa: ANN401 - YAML
    return yaml.safe_load((TEMPLATES / name).read_text("utf-8"))


def test_the_script_grades_and_writes_for_github(tmp_path: Path) -> None:
    if not bubblewrap.usable():
        pytest.skip("there is no sandbox here")
    copy_solution(STEP, tmp_path / "package")
    (tmp_path / "package" / "setup.py").unlink()  # without setup.py, nothing is built or run, which is fast
    summary = tmp_path / "summary.md"
    arguments = (tmp_path / "package", "octocat", STEP, tmp_path / "grades", "--fail-under", "60")
    env = {"CI": "true", "GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": str(summary)}
    done = run(SCRIPT, *arguments, "--repository-folder", "src/p", env=env)
    assert done.returncode == 1, done.stderr
    assert "octocat" in summary.read_text("utf-8")
    found = commands(done.stdout)
    assert {command.name for command in found} == {"error"}
    assert all(command.properties["title"].startswith("octocat: ") for command in found)
    assert [file.stem for file in (tmp_path / "grades" / "reports").glob("*.html")] == [f"octocat.{STEP}"]


@pytest.mark.parametrize("student", ["../up", "-rf", "a b", "", "$(id)"])
def test_the_script_refuses_names_that_are_not_valid_student_names(tmp_path: Path, student: str) -> None:
    done = run(SCRIPT, tmp_path, student, STEP, tmp_path / "grades")
    assert (done.returncode, "not a valid student name" in done.stderr) == (2, True)


def test_the_script_refuses_a_link_that_leads_out_of_the_repository(tmp_path: Path) -> None:
    copy_solution(STEP, tmp_path / "course" / STEP)
    (tmp_path / "submission").mkdir()
    (tmp_path / "submission" / "exercises").symlink_to("../course")
    done = subprocess.run(
        [SCRIPT, f"submission/exercises/{STEP}", "octocat", STEP, "grades"],
        cwd=tmp_path, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode, "contains a link" in done.stderr) == (2, True)
    assert not (tmp_path / "grades").exists()


@pytest.mark.parametrize("arguments", [(), ("nowhere", "octocat", STEP, "grades")])
def test_the_script_explains_a_wrong_call(tmp_path: Path, arguments: tuple[str, ...]) -> None:
    done = subprocess.run([SCRIPT, *arguments], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "grade.sh" in done.stderr


@pytest.mark.parametrize(
    ("file", "said"), [("none/a.zip", "There is no folder"), (".", "is a folder"), ("autograder", "ends in .zip")]
)
def test_a_file_that_cannot_be_the_archive_is_a_wrong_command(tmp_path: Path, file: str, said: str) -> None:
    done = run(BIN / "grader", "gradescope", "build", STEP, tmp_path / file)
    assert (done.returncode, said in " ".join(done.stderr.split())) == (2, True), done.stderr
    assert list(tmp_path.iterdir()) == []


def test_gradescopes_archive_grades_a_submission(tmp_path: Path) -> None:
    if not bubblewrap.usable():
        pytest.skip("there is no sandbox here")
    root = tmp_path / "autograder"
    build_archive(STEP, tmp_path / "autograder.zip", None)
    with unpacked(tmp_path / "autograder.zip") as folder:
        shutil.copytree(folder, root / "source")
    # On Gradescope, setup.sh creates this.
    (root / "source" / "course" / ".venv").symlink_to(BIN.parent)
    copy_solution(STEP, root / "submission" / "my_robot_controller")
    (root / "submission" / "my_robot_controller" / "setup.py").unlink()
    metadata = {"users": [{"email": "anna@example.org", "name": "Anna"}]}
    (root / "submission_metadata.json").write_text(json.dumps(metadata))
    done = run(root / "source" / "run_autograder", env={"AUTOGRADER": str(root)})
    assert done.returncode == 0, done.stdout + done.stderr
    results = json.loads((root / "results" / "results.json").read_text())
    jsonschema.validate(results, RESULTS)
    assert sum(test.get("max_score", 0.0) for test in results["tests"]) > 0.0


def test_gradescopes_archive_has_what_it_needs_and_no_solutions(tmp_path: Path) -> None:
    (tmp_path / "mine" / STEP).mkdir(parents=True)
    (tmp_path / "mine" / STEP / "exercise.toml").write_text("schema = 2\n[[check]]\nid = 'rate'\npoints = 1\n")
    build_archive("03", tmp_path / "a.zip", tmp_path / "mine", trusted=True)
    with zipfile.ZipFile(tmp_path / "a.zip") as archive:
        names = archive.namelist()
        modes = {name: archive.getinfo(name).external_attr >> 16 for name in ("setup.sh", "run_autograder")}
        assert archive.read("exercise-id") == f"{STEP}\n".encode()
    assert all(mode & 0o111 for mode in modes.values())
    assert {"trust-submissions", f"checks/{STEP}/exercise.toml", "course/requirements.lock"} <= set(names)
    assert [name for name in names if "solutions" in name or "/tests/" in name] == []


def test_gradescopes_archive_reads_a_submission_with_a_notebook(tmp_path: Path) -> None:
    """The cells of a notebook are compared with the starting point."""
    build_archive(STEP, tmp_path / "autograder.zip", None)
    with unpacked(tmp_path / "autograder.zip") as folder:
        code = (
            "import sys, grader\nfrom grader.checks.exercises import find_exercise\n"
            "from grader.submission.handed_in import open_handed_in\n"
            "opened = open_handed_in(sys.argv[1], find_exercise(sys.argv[2]))\nprint(grader.__file__, *opened.files)"
        )
        handed_in = course_folder().parent / "exercises" / STEP
        command = [sys.executable, "-c", code, str(handed_in), STEP]
        env = {**os.environ, "PYTHONPATH": f"{folder}/course:{os.environ.get('PYTHONPATH', '')}"}
        done = subprocess.run(command, env=env, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.stdout.startswith(f"{folder}/course/grader/__init__.py my_robot_controller/"), done.stderr


def test_wrong_checks_make_no_gradescope_archive(tmp_path: Path) -> None:
    (tmp_path / "mine" / STEP).mkdir(parents=True)
    (tmp_path / "mine" / STEP / "exercise.toml").write_text("schema = 2\n[[check]]\nid = 'new'\n")
    with pytest.raises(UsageError, match="kind"):
        build_archive(STEP, tmp_path / "a.zip", tmp_path / "mine")
    assert not (tmp_path / "a.zip").exists()


@pytest.mark.parametrize("name", ["grade.sh", "gradescope-setup.sh", "gradescope-run_autograder"])
def test_the_scripts_are_bash_and_executable(name: str) -> None:
    assert run("bash", "-n", TEMPLATES / name).returncode == 0
    assert os.access(TEMPLATES / name, os.X_OK)


def test_the_workflow_is_valid_and_calls_the_script() -> None:
    workflow = template("github-classroom.yml")
    job = workflow["jobs"]["grade"]
    assert workflow[True] == ["push", "workflow_dispatch"]  # `on` means true in YAML 1.1, but not on GitHub
    assert workflow["permissions"] == {"contents": "read"}
    steps = job["steps"]
    assert all(("uses" in step) != ("run" in step) for step in steps)
    runs = [step["run"] for step in steps if "run" in step]
    assert any("classroom/templates/grade.sh" in command for command in runs)
    # Text that other people choose is never part of a command.
    assert [command for command in runs if "${{" in command] == []
    for command in runs:
        assert subprocess.run(["bash", "-n", "-c", command], check=False).returncode == 0


def test_the_gitlab_job_is_valid_and_calls_the_script() -> None:
    job = template("gitlab-ci.yml")["grade"]
    assert any("classroom/templates/grade.sh" in command for command in job["script"])
    assert job["artifacts"]["reports"]["junit"] == "grades/junit.xml"
    assert all(isinstance(value, str) for value in job["variables"].values())


def test_the_readme_lists_every_template_and_says_whether_it_was_tried() -> None:
    text = (TEMPLATES / "README.md").read_text("utf-8")
    linked = set(re.findall(r"\]\(([^):]+)\)", text))
    there = {file.name for file in TEMPLATES.iterdir()} - {"README.md"}
    assert linked == there
    for name in ("github-classroom.yml", "gitlab-ci.yml", "gradescope-setup.sh", "Containerfile"):
        assert re.search(r"not (yet |been )?(tried|tested)", (TEMPLATES / name).read_text("utf-8"), re.IGNORECASE), name


def test_shellcheck_accepts_the_shell_scripts() -> None:
    if shutil.which("shellcheck") is None:
        give_up("shellcheck", "shellcheck")
    scripts = [TEMPLATES / name for name in ("grade.sh", "gradescope-setup.sh", "gradescope-run_autograder")]
    done = run("shellcheck", *scripts)
    assert done.returncode == 0, done.stdout
