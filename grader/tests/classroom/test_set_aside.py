"""Each unusual submission of a class has a line in the CSV, and all other submissions are graded."""

from __future__ import annotations

import errno
import os
import shutil
import struct
import subprocess
import tempfile
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise
from grader.checks.outcome import Status
from grader.classroom import archives, content
from grader.classroom.content import read
from grader.classroom.find_submissions import find_submissions
from grader.classroom.found import Found
from grader.classroom.order import Order, sources_for
from grader.classroom.refused import Refused
from grader.classroom.task import perform
from grader.common.interpreter import interpreter
from grader.errors import DiskError, MachineError, UsageError
from grader.tests.case import copy_solution
from grader.tests.classroom.a_class import STEP, grade, rows
from grader.tests.lacking import need_reachable_python

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

EXERCISE = find_exercise(STEP)
XML = ("p/package.xml", b"<package/>")


def packed(file: Path, name: str = XML[0], how: int = zipfile.ZIP_STORED, content: bytes = XML[1]) -> bytearray:
    with zipfile.ZipFile(file, "w", how) as archive:
        archive.writestr(name, content)
    return bytearray(file.read_bytes())


def a_long_name(folder: Path) -> None:
    packed(folder / "odd.zip", f"p/{'n' * 300}.py")


def damaged(how: int) -> Callable[[Path], None]:
    def damage(folder: Path) -> None:
        data = packed(folder / "odd.zip", how=how, content=os.urandom(20_000))
        data[70:400] = bytes(330)
        (folder / "odd.zip").write_bytes(data)

    return damage


def an_offset_beyond_the_file(folder: Path) -> None:
    """Create a zip64 archive with an offset beyond the end of the file."""
    data = packed(folder / "odd.zip")
    at, end = data.index(b"PK\x01\x02"), data.index(b"PK\x05\x06")
    record, tail = data[at:end], data[end:]
    extra = struct.pack("<HHQ", 1, 8, 2**63 - 5)
    struct.pack_into("<H", record, 30, len(extra))
    struct.pack_into("<L", record, 42, 0xFFFFFFFF)
    struct.pack_into("<LL", tail, 12, len(record) + len(extra), at)
    (folder / "odd.zip").write_bytes(data[:at] + record + extra + tail)


def latin_1(folder: Path) -> None:
    (folder / os.fsdecode(b"m\xfcller")).mkdir()


def a_closed_folder(folder: Path) -> None:
    copy_solution(STEP, folder / "odd")
    (folder / "odd").chmod(0)


def a_circle_of_links(folder: Path) -> None:
    (folder / "odd").symlink_to("odd")


def hidden(folder: Path) -> None:
    copy_solution(STEP, folder / ".odd")


def another_exercise_beside_it(folder: Path) -> None:
    copy_solution(STEP, folder / "odd" / "my_robot_controller")
    (folder / "odd" / "04-package-files").mkdir()


def a_file_that_is_no_archive(folder: Path) -> None:
    (folder / "odd.rar").write_bytes(b"Rar!")


def twice(folder: Path) -> None:
    (folder / "odd").mkdir()
    packed(folder / "odd.zip")


def a_name_for_a_terminal(folder: Path) -> None:
    (folder / "\x1b[31modd\n").mkdir()


def a_name_as_long_as_can_be(folder: Path) -> None:
    (folder / ("n" * 255)).mkdir()


def nothing(folder: Path) -> None:
    (folder / "odd").mkdir()


ODD: dict[str, tuple[Callable[[Path], None], str]] = {
    "a long name": (a_long_name, "a file name that the disk does not accept"),
    "damaged bzip2": (damaged(zipfile.ZIP_BZIP2), "damaged"),
    "damaged lzma": (damaged(zipfile.ZIP_LZMA), "damaged"),
    "damaged deflate": (damaged(zipfile.ZIP_DEFLATED), "damaged"),
    "an offset beyond the file": (an_offset_beyond_the_file, "damaged"),
    "latin 1": (latin_1, "no package"),
    "a circle of links": (a_circle_of_links, "is a symbolic link"),
    "hidden": (hidden, "begins with a dot"),
    "another exercise": (another_exercise_beside_it, "contains 04-package-files, but no folder 03-circle-publisher"),
    "no archive": (a_file_that_is_no_archive, "is not a supported archive"),
    "twice": (twice, "has 2 submissions"),
    "a name for a terminal": (a_name_for_a_terminal, "no package"),
    "a long name of a folder": (a_name_as_long_as_can_be, "no package"),
    "nothing": (nothing, "no package"),
}


@pytest.mark.parametrize("name", ODD)
def test_an_odd_submission_is_refused_with_the_reason(tmp_path: Path, name: str) -> None:
    make, why = ODD[name]
    make(tmp_path)
    (one,) = find_submissions([tmp_path], STEP, tmp_path / "grades")
    refused = read(one, EXERCISE, "odd")
    assert isinstance(refused, Refused)
    assert why in refused.reason
    assert str(tmp_path) not in refused.reason or name == "twice"
    order = Order(found=(one,), roster={}, sources=sources_for((one,), None), ros="none", trusted=True)
    assert order.key(one) == order.key(one)
    report = perform(order.task(one)).report
    assert (report.points, report.max, report.with_status(Status.ERROR)) == (0.0, 100.0, ())


def test_a_class_of_odd_submissions_is_graded_completely(tmp_path: Path) -> None:
    for number, (make, _) in enumerate(ODD.values()):
        (tmp_path / "made" / str(number)).mkdir(parents=True)
        make(tmp_path / "made" / str(number))
        for path in (tmp_path / "made" / str(number)).iterdir():
            (tmp_path / "class").mkdir(exist_ok=True)
            dot = "." if path.name.startswith(".") else ""
            path.rename(tmp_path / "class" / f"{dot}{number}{path.name[:250]}")
    copy_solution(STEP, tmp_path / "class" / "zoe")
    done = grade(tmp_path / "class", "--exercise", STEP, "--out", tmp_path / "grades", "--trust-submissions")
    assert done.returncode == 0, done.stderr
    found = rows(tmp_path / "grades")
    assert len(found) == len(list((tmp_path / "class").iterdir())) - 1  # two submissions belong to the same student
    assert {row["points"] for row in found[:-1]} == {"0"}
    assert (found[-1]["submission"], found[-1]["points"]) == ("zoe", "100")
    assert "Traceback" not in done.stderr


LOOK = """
import pathlib, sys
from grader.checks.exercises import find_exercise
from grader.classroom.content import fingerprint, read
from grader.classroom.find_submissions import find_submissions, passed_over
folder = pathlib.Path(sys.argv[1])
for found in find_submissions([folder], sys.argv[2], folder):
    exercise = find_exercise(sys.argv[2])
    content = read(found, exercise, "")
    print(found.student, fingerprint(found, exercise) == fingerprint(found, exercise), getattr(content, "reason", ""))
passed_over([folder], folder)
"""


@pytest.fixture
def entered_by_all() -> Iterator[Path]:
    """Return a folder that other users can enter, unlike pytest's own folders."""
    with tempfile.TemporaryDirectory(prefix="set-aside-") as named:
        Path(named).chmod(0o755)
        yield Path(named)


def test_a_folder_without_permission_is_reported(entered_by_all: Path) -> None:
    need_reachable_python()
    a_closed_folder(entered_by_all)
    start = interpreter("-c", LOOK)
    # root can enter every folder
    as_somebody = ["setpriv", "--reuid=65534", "--clear-groups"] if os.getuid() == 0 else []
    command = [*as_somebody, *start.argv, str(entered_by_all), STEP]
    done = subprocess.run(command, env=start.env, capture_output=True, text=True, check=False)
    (entered_by_all / "odd").chmod(0o755)
    assert "odd True" in done.stdout, done.stderr
    assert "because of its permissions" in done.stdout


def breaks(error: Exception) -> Callable[..., object]:
    def broken(*_: object) -> object:
        raise error

    return broken


@pytest.mark.parametrize("error", [MachineError("The disk is odd."), OSError(errno.EIO, "Input/output error")])
def test_a_fault_of_the_machine_at_one_submission_does_not_stop_others(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, error: Exception
) -> None:
    one = Found("anna", STEP, tmp_path)
    monkeypatch.setattr(content, "_open", breaks(error))
    order = Order(found=(one,), roster={}, sources=sources_for((one,), None), ros="none", trusted=True)
    report = perform(order.task(one)).report
    assert report.points == 0.0
    assert str(error.args[-1]).rstrip(".") in report.outcomes[0].finding.observed


def test_only_a_fault_of_the_graders_own_disk_stops_a_class(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    packed(tmp_path / "odd.zip")
    monkeypatch.setattr(archives, "unpacked", breaks(DiskError("full")))
    with pytest.raises(DiskError):
        read(Found("odd", STEP, tmp_path / "odd.zip"), EXERCISE, "odd")


def test_a_student_without_an_exercise_gets_a_line_for_each_exercise_of_the_others(tmp_path: Path) -> None:
    (tmp_path / "anna" / STEP).mkdir(parents=True)
    (tmp_path / "ben").mkdir()
    found = find_submissions([tmp_path], None, tmp_path / "grades")
    assert [(each.student, each.exercise, each.refused) for each in found] == [
        ("anna", STEP, None),
        ("ben", STEP, Refused(f"ben does not contain a folder {STEP}.", "exercise-missing")),
    ]
    shutil.rmtree(tmp_path / "anna")
    with pytest.raises(UsageError, match="Which exercise is"):
        find_submissions([tmp_path], None, tmp_path / "grades")
