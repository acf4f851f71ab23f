"""nbgrader refuses folders and notebooks that attack it, and grades all other submissions."""

from __future__ import annotations

import copy
import json
import os
import shutil
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import nbformat
import nbgrader.utils  # noqa: F401 - otherwise each child would import it
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from grader.errors import TooLargeError, UnreadableError
from grader.gradebook import readable
from grader.sandbox import bubblewrap
from grader.submission.reader import read
from grader.tests.gradebook.term import FIRST, LATER, Term

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

SECRET = "the instructor's secret"
HOMEWORK = "homework"
LARGE = 20 * 1024**3


def a_notebook(*cells: Any) -> str:  # noqa: ANN401 - nbformat's cells
    return str(nbformat.writes(new_notebook(cells=list(cells))))  # type: ignore[no-untyped-call]


def code(source: str) -> Any:  # noqa: ANN401
    return new_code_cell(source)  # type: ignore[no-untyped-call, no-any-return, unused-ignore]


def sparse(file: Path) -> None:
    file.unlink(missing_ok=True)
    with file.open("wb") as opened:
        opened.truncate(LARGE)


def pipe(file: Path) -> None:
    file.unlink(missing_ok=True)
    os.mkfifo(file)


def link(file: Path, target: str) -> None:
    file.unlink(missing_ok=True)
    file.symlink_to(target)


NOTEBOOKS: dict[str, tuple[Callable[[Path], object], str]] = {
    "a pipe": (pipe, "is not a regular file"),
    "a link to endless zeros": (lambda file: link(file, "/dev/zero"), "changed while it was being read"),
    "a link to another student's": (lambda file: link(file, __file__), "changed while it was being read"),
    "20 GiB": (sparse, "is larger than the maximum of 8388608 bytes"),
    "deep lists": (lambda file: file.write_text("[" * 100_000 + "]" * 100_000), "nested too deeply"),
    "deep metadata": (
        lambda file: file.write_text(
            a_notebook(code("1")).replace('"metadata": {}', '"metadata": {"a": ' + "[" * 90 + "]" * 90 + "}", 1)
        ),
        "objects nested more than 50 levels deep",
    ),
    "many values": (
        lambda file: file.write_text(json.dumps({"cells": [], "metadata": {"a": [[]] * 1_000_000}})),
        "more than 500000 values",
    ),
    "many cells": (
        lambda file: file.write_text(a_notebook(*(code("1") for _ in range(1001)))),
        "1001 cells, but the maximum is 1000",
    ),
    "a long number": (lambda file: file.write_text('{"nbformat": ' + "9" * 5000 + "}"), "could not be read"),
    "half a letter": (
        lambda file: file.write_text(a_notebook(code("x")).replace('"x"', '"\\ud800"')),
        "could not be read",
    ),
    "bytes": (lambda file: file.write_bytes(b"\xff\xfe\0"), "could not be read"),
    "a list": (lambda file: file.write_text("[]"), "could not be read"),
    "an old format of nothing": (lambda file: file.write_text('{"nbformat": 3, "worksheets": 7}'), "could not be read"),
}


@pytest.mark.parametrize("name", NOTEBOOKS)
def test_a_notebook_that_is_not_small_and_regular_is_refused(name: str, tmp_path: Path) -> None:
    make, why = NOTEBOOKS[name]
    make(tmp_path / "a.ipynb")
    with pytest.raises(UnreadableError) as raised:
        read(readable.notebook, tmp_path / "a.ipynb")
    assert why in str(raised.value)


def test_a_notebook_of_an_older_format_is_converted(tmp_path: Path) -> None:
    cell = {"cell_type": "code", "input": "2 + 2", "outputs": [], "language": "python", "metadata": {}}
    old = {"nbformat": 3, "nbformat_minor": 0, "metadata": {"name": ""}, "worksheets": [{"cells": [cell]}]}
    (tmp_path / "a.ipynb").write_text(json.dumps(old))
    again = json.loads(read(readable.notebook, tmp_path / "a.ipynb"))
    assert (again["nbformat"], again["cells"][0]["source"]) == (4, ["2 + 2"])


TIMES: dict[str, Callable[[Path], object]] = {
    "a word": lambda file: file.write_text("yesterday evening"),
    "a date that no calendar has": lambda file: file.write_text("9" * 60),
    "the end of all time": lambda file: file.write_text("9999-12-31 23:59:59 UTC"),
    "the beginning of all time": lambda file: file.write_text("0001-01-01 00:00:00 UTC"),
    "20 GiB": sparse,
    "a pipe": pipe,
    "a link": lambda file: link(file, "/dev/zero"),
    "a folder": lambda file: file.mkdir(),
    "bytes": lambda file: file.write_bytes(b"\xff\0"),
}


@pytest.mark.parametrize("name", TIMES)
def test_a_time_that_is_none_is_refused(name: str, tmp_path: Path) -> None:
    TIMES[name](tmp_path / readable.TIMESTAMP)
    with pytest.raises((UnreadableError, TooLargeError)):
        read(readable.time_of, tmp_path)


def test_a_time_is_read_as_nbgrader_reads_it(tmp_path: Path) -> None:
    assert read(readable.time_of, tmp_path) is None
    (tmp_path / readable.TIMESTAMP).write_text(f"{FIRST}\n")
    assert str(read(readable.time_of, tmp_path)) == "2027-03-01 10:00:00"


@dataclass(frozen=True)
class Hostile:
    """A class that was attacked: its folder, the output of the commands, and the score of each student."""

    folder: Path
    collected: str
    graded: str
    scores: dict[str, float]


@pytest.fixture(scope="module")
def hostile(tmp_path_factory: pytest.TempPathFactory) -> Hostile:
    """Grade a class with a short assignment. The exchange contains attacks and an honest submission."""
    if not bubblewrap.usable():
        pytest.skip("autograde runs submissions only in a sandbox")
    folder = tmp_path_factory.mktemp("term")
    secret = folder / "secret"
    secret.write_text(SECRET)
    term = Term(folder)
    (term.root / "solutions" / HOMEWORK).mkdir()
    cell = code("print(open('notes.txt').read() if __import__('os').path.exists('notes.txt') else 'none')\n1")
    cell.metadata = {
        "nbgrader": {
            "grade": True, "grade_id": "one", "locked": True, "points": 1, "schema_version": 3, "solution": False,
            "task": False,
        }
    }  # fmt: skip
    (term.root / "solutions" / HOMEWORK / f"{HOMEWORK}.ipynb").write_text(a_notebook(cell))
    term.run("generate_assignment", HOMEWORK)
    term.run("release_assignment", HOMEWORK)
    for name, change in SUBMISSIONS.items():
        hand_in(term, name, change, secret)
    inbound = term.exchange / term.root.name / "inbound"
    (inbound / f"mallory+{HOMEWORK}+when I had time").mkdir()
    (inbound / f"mallory+{HOMEWORK}+{LATER}").symlink_to(f"anna+{HOMEWORK}+{FIRST}")
    (inbound / f"nobody+{HOMEWORK}+{LATER}").symlink_to("nowhere")
    for student in ("..", ".hidden", TITLE, "?nna"):
        shutil.copytree(inbound / f"anna+{HOMEWORK}+{FIRST}", inbound / f"{student}+{HOMEWORK}+{FIRST}")
    collected = term.run("collect", HOMEWORK)
    # An instructor may also add submissions without nbgrader's exchange.
    for name, change in BESIDE.items():
        to = term.root / "class" / "submitted" / name / HOMEWORK
        shutil.copytree(term.root / "exercises" / HOMEWORK, to)
        change(to, secret)
    graded = term.run("autograde", HOMEWORK, "--create", fails=True)
    term.run("generate_feedback", HOMEWORK)
    return Hostile(term.root / "class", collected, graded, scores(term))


def hand_in(term: Term, student: str, change: Callable[[Path, Path], object], secret: Path) -> None:
    to = term.exchange / term.root.name / "inbound" / f"{student}+{HOMEWORK}+{FIRST}"
    shutil.copytree(term.root / "exercises" / HOMEWORK, to)
    (to / readable.TIMESTAMP).write_text(FIRST)
    change(to, secret)


TITLE = "\x1b]0;a title of a student\x07"  # as a name, it changes the title of any terminal in which it is printed
MARKDOWN = "<script>steal()</script> [a](javascript:steal()) <div onclick=steal()>x</div> <style>*{color:red}</style>"


def with_script(folder: Path, _: Path) -> None:
    file = folder / f"{HOMEWORK}.ipynb"
    notebook = nbformat.read(file, as_version=4)  # type: ignore[no-untyped-call]
    html = "from IPython.display import HTML\nHTML('<img src=x onerror=steal()>')"
    notebook.cells += [new_markdown_cell(f"# Title\n\n{MARKDOWN}"), code(html)]  # type: ignore[no-untyped-call]
    nbformat.write(notebook, file)  # type: ignore[no-untyped-call]


def with_links(folder: Path, secret: Path) -> None:
    (folder / "notes.txt").symlink_to(secret)
    (folder / "zeros.txt").symlink_to("/dev/zero")
    os.mkfifo(folder / "pipe.txt")


def edited(folder: Path, change: Callable[[Any], object]) -> None:
    file = folder / f"{HOMEWORK}.ipynb"
    notebook = nbformat.read(file, as_version=4)  # type: ignore[no-untyped-call]
    change(notebook)
    nbformat.write(notebook, file)  # type: ignore[no-untyped-call]


def of_version(version: object) -> Callable[[Path, Path], object]:
    """Add a cell with nbgrader's metadata in another version. nbgrader itself then stops, and asks for an update."""
    cell = code("2")
    cell.metadata = {"nbgrader": {"schema_version": version, "grade": False, "solution": False, "locked": False}}
    return lambda folder, _: edited(folder, lambda notebook: notebook.cells.append(cell))


def twice(folder: Path, _: Path) -> None:
    """Copy each cell with its nbgrader id. nbgrader itself then stops, and asks for an update."""
    edited(folder, lambda notebook: notebook.cells.extend(copy.deepcopy(notebook.cells)))


def with_a_picture(folder: Path, _: Path) -> None:
    """Add a picture that the student has attached to a cell, and a picture that does not exist."""
    cell = new_markdown_cell("![mine](attachment:a.png) ![none](attachment:b.png)")  # type: ignore[no-untyped-call]
    cell.attachments = {"a.png": {"image/png": "AAAA"}}
    edited(folder, lambda notebook: notebook.cells.append(cell))


def at_no_time(folder: Path, _: Path) -> None:
    (folder / readable.TIMESTAMP).write_text("yesterday evening")


def beside(folder: Path, secret: Path) -> None:
    (folder / "notes.txt").symlink_to(secret)
    sparse(folder / "large.txt")
    (folder / f"{TITLE}.ipynb").write_text("{}")
    (folder / "index.html").write_text("<script>steal()</script>")


SUBMISSIONS: dict[str, Callable[[Path, Path], object]] = {"anna": with_script, "links": with_links, "when": at_no_time}
BESIDE: dict[str, Callable[[Path, Path], object]] = {
    "beside": beside,
    "never": at_no_time,
    "deep": lambda folder, _: (folder / f"{HOMEWORK}.ipynb").write_text("[" * 100_000),
    "blocks": lambda folder, _: pipe(folder / f"{HOMEWORK}.ipynb"),
    "copied": twice,
    "newer": of_version(99),
    "picture": with_a_picture,
    "*": lambda _, __: None,
    TITLE: lambda folder, _: (folder / f"{HOMEWORK}.ipynb").unlink(),
    "e\nforged": lambda _, __: None,
}
"""Map a student to what is wrong with the student's folder in the exchange (SUBMISSIONS) or in submitted/ (BESIDE)."""


def scores(term: Term) -> dict[str, float]:
    with term.gradebook() as gradebook:
        return {each.student.id: each.score for each in gradebook.assignment_submissions(HOMEWORK)}


def test_collect_takes_only_regular_files_of_the_submission(hostile: Hostile) -> None:
    submitted = hostile.folder / "submitted"
    assert sorted(path.name for path in submitted.iterdir()) == sorted(["anna", "links", "when", *BESIDE])
    assert not (submitted.parent / HOMEWORK).exists()
    assert TITLE not in hostile.collected
    for why in ("it is not a folder", "the name has characters that cannot be printed"):
        assert f"Not collected, because {why}" in hostile.collected
    assert not (submitted / "when" / HOMEWORK).exists()
    files = {path.name for path in (submitted / "links" / HOMEWORK).iterdir()}
    assert files == {f"{HOMEWORK}.ipynb", readable.TIMESTAMP}
    assert "does not contain a valid time" in hostile.collected
    assert "timestamp.txt does not contain a valid time" in hostile.collected
    assert "notes.txt is a link to" in hostile.collected


def test_autograde_continues_after_submissions_that_attack_it(hostile: Hostile) -> None:
    full = {name for name, score in hostile.scores.items() if score == 1.0}
    assert full == {"*", "anna", "beside", "copied", "links", "newer", "picture"}
    assert "for student '*'" not in hostile.graded
    assert TITLE not in hostile.graded
    for student in ("never", "deep", "blocks"):
        assert f"error processing assignment '{HOMEWORK}' for student '{student}'" in hostile.graded
        assert not (hostile.folder / "autograded" / student / HOMEWORK).exists()


def test_nothing_of_the_instructor_reaches_a_copy_that_a_kernel_can_read(hostile: Hostile) -> None:
    copies = [path for path in hostile.folder.rglob("*") if path.is_file() and path.stat().st_size < 10**7]
    outside = hostile.folder / "submitted" / "beside" / HOMEWORK / "notes.txt"
    assert [path for path in copies if path != outside and SECRET.encode() in path.read_bytes()] == []


def test_feedback_runs_no_script_of_a_student(hostile: Hostile) -> None:
    files = list((hostile.folder / "feedback").rglob("*.*"))
    assert {each.name for each in files} == {f"{HOMEWORK}.html", readable.TIMESTAMP}
    page = next(each for each in files if "anna" in each.parts and each.suffix == ".html").read_text("utf-8")
    assert "<h1>Title" in page
    assert "steal()" in page  # the script is shown as text
    scripts = ("<script>steal", "<img src=x", 'href="javascript', "<div onclick", "<style>*")
    assert [each for each in scripts if each in page] == []
