"""`grader grade` on a small class, with the real programs."""

from __future__ import annotations

import dataclasses
import json
import shutil
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from grader.checks.judge import judge
from grader.classroom.found import Found
from grader.classroom.order import Order
from grader.evidence.evidence import Evidence
from grader.exercise.private_checks import sources_of
from grader.submission.package import open_submission
from grader.tests.both_worlds import python_path
from grader.tests.case import copy_solution
from grader.tests.classroom.a_class import ACTS, POINTS, STEP, grade, judged, make_class, reports, rows
from grader.tests.grading.test_grade import busy

if TYPE_CHECKING:
    from pathlib import Path

    from grader.tests.classroom.conftest import Run

WITHOUT_SANDBOX = "from grader.sandbox import bubblewrap\nbubblewrap.program = lambda: None\n"


def test_every_submission_gets_its_points(undisturbed: Run) -> None:
    assert undisturbed.done.returncode == 0, undisturbed.done.stdout + undisturbed.done.stderr
    assert {student: report["points"] for student, report in reports(undisturbed.out).items()} == POINTS


def test_every_submission_has_a_page(undisturbed: Run) -> None:
    pages = [file.stem for file in (undisturbed.out / "reports").glob("*.html")]
    assert sorted(pages) == sorted(file.stem for file in (undisturbed.out / "reports").glob("*.json"))


@pytest.mark.parametrize(
    ("student", "diagnosis", "said"),
    [
        ("gina", "no-package", "There is no package in gina"),
        ("hans", "archive-damaged", "hans.zip is not a .zip or .tar.gz"),
    ],
)
def test_a_submission_without_a_package_gets_no_points_and_a_reason(
    undisturbed: Run, student: str, diagnosis: str, said: str
) -> None:
    report = reports(undisturbed.out)[student]
    first, *others = report["outcomes"]
    assert (report["points"], report["max"]) == (0, 100)
    assert (first["status"], first["diagnosis"]) == ("failed", diagnosis)
    assert said in first["seen"]
    assert str(undisturbed.submitted) not in json.dumps(report)
    assert {outcome["status"] for outcome in others} == {"skipped"}


def test_a_pipe_gets_one_line_per_submission_and_none_controls_a_ci(undisturbed: Run) -> None:
    lines = undisturbed.done.stderr.splitlines()
    assert sum(line.startswith("[") for line in lines) == len(POINTS)
    assert not [line for line in lines if line.lstrip().startswith("::") or "##[" in line]
    assert "\x1b" not in undisturbed.done.stderr + undisturbed.done.stdout


def test_a_second_run_grades_only_what_changed(undisturbed: Run, tmp_path: Path) -> None:
    submitted, out = tmp_path / "submitted", tmp_path / "grades"
    shutil.copytree(undisturbed.submitted, submitted)
    shutil.copytree(undisturbed.out, out)
    before = {file.name: file.stat().st_mtime_ns for file in (out / "reports").iterdir()}
    (submitted / "gina" / "more.txt").write_text("Still nothing.")
    shutil.rmtree(submitted / ACTS)
    done = grade(submitted, "--exercise", STEP, "--out", out)
    assert "8 submissions: 7 already graded, 1 to grade (1 changed)." in done.stdout
    assert (
        "1 result of other submissions in" in done.stdout
    )  # the result of the removed submission stays, but is not counted
    again = {name for name, when in before.items() if (out / "reports" / name).stat().st_mtime_ns != when}
    assert again == {f"gina.{STEP}.json", f"gina.{STEP}.html"}
    assert sorted(row["submission"] for row in rows(out)) == sorted(POINTS.keys() - {ACTS})


def test_results_of_an_older_grader_and_errors_are_made_again(undisturbed: Run, tmp_path: Path) -> None:
    submitted, out = tmp_path / "submitted", tmp_path / "grades"
    shutil.copytree(undisturbed.out, out)
    shutil.copytree(undisturbed.submitted / "gina", submitted / "gina")
    shutil.copyfile(undisturbed.submitted / "hans.zip", copied(submitted) / "hans.zip")
    older, broken = (out / "reports" / f"{name}.{STEP}.json" for name in ("gina", "hans"))
    data = json.loads(older.read_text())
    older.write_text(json.dumps({**data, "key": {**data["key"], "grader": "0.0.1 0123456789abcdef"}}))
    broken.write_text(broken.read_text()[:100])
    done = grade(submitted, "--exercise", STEP, "--out", out)
    assert "1 graded by another version of the grader" in done.stdout
    assert "2 to grade" in done.stdout
    assert judged(out) == judged(undisturbed.out)


def copied(folder: Path) -> Path:
    folder.mkdir(exist_ok=True)
    return folder


@pytest.mark.parametrize(("under", "code"), [("0", 0), ("60", 1)])
def test_fail_under_is_the_exit_code(undisturbed: Run, tmp_path: Path, under: str, code: int) -> None:
    out = tmp_path / "grades"
    shutil.copytree(undisturbed.out, out)
    done = grade(undisturbed.submitted, "--exercise", STEP, "--out", out, "--fail-under", under)
    assert (done.returncode, "nothing to grade" in done.stdout) == (code, True), done.stderr


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["{class}"], "Name the exercise with --exercise"),
        (["{class}", "--exercise", "99"], "there is no exercise"),
        (["{class}/nowhere", "--exercise", STEP], "does not exist"),
        (["{class}/gina/notes.txt", "--exercise", STEP], "neither a folder nor an archive"),
        (["{class}/gina", "--exercise", STEP], "No submission was found"),
        (["{class}", "--exercise", STEP, "--engine", "cloud"], "The engine must be local or dask://HOST:PORT"),
        (["{class}", "--exercise", STEP, "--engine", "dask://host"], "The engine must be local or dask://HOST:PORT"),
        (["{class}", "--exercise", STEP, "--engine", "dask://:8786"], "The engine must be local or dask://HOST:PORT"),
        (["{class}", "--exercise", STEP, "--checks", "{class}"], "There are no checks in"),
        (["{class}", "--exercise", STEP, "--roster", "{class}/hans.zip"], "is not a roster"),
        (["{class}", "--exercise", STEP, "--out", "{class}"], "contains files that are not results"),
        (["{class}", "--exercise", STEP, "--jobs", "0"], "jobs"),
    ],
)
def test_a_wrong_command_is_one_sentence_and_exit_code_2(
    undisturbed: Run, tmp_path: Path, arguments: list[str], said: str
) -> None:
    given = [text.replace("{class}", str(undisturbed.submitted)) for text in arguments]
    done = grade(*([] if "--out" in given else ["--out", tmp_path / "new"]), *given)
    reported = " ".join(done.stderr.split())
    assert (done.returncode, said in reported) == (2, True), done.stderr
    assert "Traceback" not in done.stderr


def test_without_a_sandbox_nothing_is_run(undisturbed: Run, tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text(WITHOUT_SANDBOX)
    command = (undisturbed.submitted, "--exercise", STEP, "--out", tmp_path / "new")
    done = grade(*command, PYTHONPATH=python_path(tmp_path))
    assert (done.returncode, "No sandbox is available" in done.stderr) == (3, True), done.stderr
    assert not (tmp_path / "new").exists()


def test_trusted_submissions_are_graded_without_a_sandbox(tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text(WITHOUT_SANDBOX)
    copy_solution(STEP, tmp_path / "class" / "anna")
    command = (tmp_path / "class", "--exercise", STEP, "--out", tmp_path / "new", "--trust-submissions")
    done = grade(*command, PYTHONPATH=python_path(tmp_path))
    assert done.returncode == 0, done.stderr
    assert [(row["submission"], row["points"]) for row in rows(tmp_path / "new")] == [("anna", "100")]


def test_two_runs_at_once_do_not_share_a_folder(undisturbed: Run, tmp_path: Path) -> None:
    out = tmp_path / "grades"
    out.mkdir()
    hold = "import fcntl, sys; f = open(sys.argv[1], 'a'); fcntl.flock(f, fcntl.LOCK_EX); print(flush=True); input()"
    with subprocess.Popen(
        [sys.executable, "-c", hold, str(out / ".grader-results")],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    ) as other:
        assert other.stdout is not None
        other.stdout.readline()
        done = grade(undisturbed.submitted, "--exercise", STEP, "--out", out)
        other.communicate(b"\n")
    assert done.returncode == 2
    assert "Another `grader grade` or `grader gradebook sync` is using" in done.stderr


def test_partial_files_of_a_killed_run_are_removed(undisturbed: Run, tmp_path: Path) -> None:
    out = tmp_path / "grades"
    shutil.copytree(undisturbed.out, out)
    leftover = out / "reports" / f"anna.{STEP}.html.partial"
    leftover.write_text("half a pa")
    done = grade(undisturbed.submitted, "--exercise", STEP, "--out", out)
    assert (done.returncode, leftover.exists()) == (0, False)


@pytest.mark.parametrize(
    ("roster", "expected"),
    [({}, "numbers-of-another"), ({"anna": "SOMEBODY"}, "numbers-of-another"), ({"anna": "{owner}"}, None)],
)
def test_numbers_of_another_student_do_not_count(tmp_path: Path, roster: dict[str, str], expected: str | None) -> None:
    step = "07-challenges"
    copy_solution(step, tmp_path / "anna")
    lines = (tmp_path / "anna" / "my_numbers.toml").read_text("utf-8").splitlines()
    owner = next(line.split('"')[1] for line in lines if line.startswith("student"))
    found = Found("anna", step, tmp_path / "anna")
    given = {student: id_.replace("{owner}", owner.upper()) for student, id_ in roster.items()}
    order = Order(found=(found,), roster=given, sources=sources_of({step}, None), ros="none")
    task = order.task(found)
    submission = dataclasses.replace(open_submission(tmp_path / "anna"), student=task.owner)
    outcomes = judge(Evidence(order.exercises[step], submission))
    assert [each.finding.diagnosis for each in outcomes if each.kind == "own_numbers"] == [expected]


def test_nbgraders_folders_name_student_and_exercise(undisturbed: Run, tmp_path: Path) -> None:
    submitted, out = tmp_path / "submitted", tmp_path / "grades"
    shutil.copytree(undisturbed.submitted / "gina", submitted / "gina" / STEP)
    copy_solution("02-discover-topics", submitted / "anna" / "02-discover-topics")
    (submitted / "anna" / "02-discover-topics" / "timestamp.txt").write_text("2026-11-21 12:00:00 UTC")
    done = grade(submitted, "--out", out)
    assert done.returncode == 0, done.stderr
    assert [(row["submission"], row["exercise"], row["points"]) for row in rows(out)] == [
        ("anna", "02-discover-topics", "100"),
        ("gina", STEP, "0"),
    ]


@pytest.mark.exhaustive
def test_load_and_parallel_grading_do_not_change_results(tmp_path: Path) -> None:
    submitted = make_class(tmp_path / "submitted")
    first = grade(submitted, "--exercise", STEP, "--out", tmp_path / "idle", "--jobs", "1")
    assert first.returncode == 0, first.stderr
    with busy(4):
        loaded = grade(submitted, "--exercise", STEP, "--out", tmp_path / "loaded", "--jobs", "4")
    assert loaded.returncode == 0, loaded.stderr
    assert judged(tmp_path / "idle") == judged(tmp_path / "loaded")
