"""A notebook that cannot be combined with its package does not stop the grading of other notebooks."""

from __future__ import annotations

import errno
import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, NoReturn

import pytest

from grader.classroom.content import read
from grader.classroom.refused import Refused
from grader.errors import MachineError
from grader.gradebook import scores
from grader.gradebook.scores import _readable
from grader.tests.submission.test_handed_in import CIRCLE, FILE, handed_in

if TYPE_CHECKING:
    from pathlib import Path

ODD = {
    "a lone surrogate": "%%node draw_circle.py\nprint('\ud800')",
    "a NUL": "%%node a\0b.py\nx",
    "300 letters": f"%%node {'n' * 300}.py\nx",
    "a dot": "%%node .\nx",
    "two dots": "%%package ..\nx",
    "a file below a file": "%%package package.xml/below\nx",
    "a file in a folder's place": "%%package my_robot_controller\nx",
}


@dataclass(frozen=True)
class Folders:
    """The folders, named as in gradebook.class_folders.ClassFolders."""

    root: Path

    def submitted(self, student: str, _: str) -> Path:
        return self.root / "submitted" / student


def with_cell(folder: Path, source: str) -> None:
    file = folder / f"{CIRCLE.id}.ipynb"
    notebook = json.loads(file.read_text("utf-8"))
    notebook["cells"].append({"cell_type": "code", "source": source})
    file.write_text(json.dumps(notebook), "utf-8")


def make(root: Path) -> Folders:
    """Create the unusual notebooks and an honest notebook."""
    folders = Folders(root)
    (root / "submitted").mkdir()
    for student in (*ODD, "zoe"):
        folder = handed_in(folders.submitted(student, ""), "mine", {"my_robot_controller/package.xml": "<package/>"})
        if student in ODD:
            with_cell(folder, ODD[student])
    return folders


def test_each_is_graded_or_reported_and_the_others_continue(tmp_path: Path) -> None:
    folders = make(tmp_path)
    found, why = _readable(folders, [(student, CIRCLE.id) for student in (*ODD, "zoe")])  # type: ignore[arg-type]
    assert [each.student for each in found] == [*ODD, "zoe"]
    assert {each.student for each in found if each.refused} == {student for student, _ in why}
    zoe = read(found[-1], CIRCLE, "zoe")
    assert not isinstance(zoe, Refused)
    assert zoe.files[FILE] == b"mine\n"
    assert "a file below a file" in {student for student, _ in why}


def test_a_link_to_the_work_of_another_student_is_reported(tmp_path: Path) -> None:
    folders = Folders(tmp_path)
    (tmp_path / "submitted").mkdir()
    handed_in(folders.submitted("zoe", ""), "mine", {"my_robot_controller/package.xml": "<package/>"})
    folders.submitted("mallory", "").symlink_to("zoe")
    mallory, zoe = _readable(folders, [("mallory", CIRCLE.id), ("zoe", CIRCLE.id)])[0]  # type: ignore[arg-type]
    assert mallory.refused is not None
    assert "the folder of mallory is a symbolic link" in mallory.refused.reason
    assert mallory.refused.diagnosis == "submission-link"
    assert not zoe.refused


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT, errno.EIO, errno.EROFS])
def test_a_full_disk_of_the_grader_stops_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int) -> None:
    folders = make(tmp_path)

    def full(*_: object) -> NoReturn:
        message = "full"
        raise MachineError(message) from OSError(number, "full")

    monkeypatch.setattr(scores, "open_handed_in", full)
    with pytest.raises(MachineError):
        _readable(folders, [("zoe", CIRCLE.id)])  # type: ignore[arg-type]
