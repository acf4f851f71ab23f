"""Each reason why a submission cannot be graded has a diagnosis, under which the class page counts it."""

from __future__ import annotations

import tarfile
import unicodedata
import zipfile
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise
from grader.classroom import unpack
from grader.classroom.content import read
from grader.classroom.find_submissions import find_submissions
from grader.classroom.order import Order, sources_for
from grader.classroom.refused import Refused
from grader.classroom.task import perform, set_aside
from grader.report.class_reports import ClassReports, Entry
from grader.report.html_class import failures
from grader.report.suspicion import suspicions
from grader.submission import tree
from grader.tests.case import copy_solution

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

STEP = "03-circle-publisher"


def empty(folder: Path) -> None:
    (folder / "ben").mkdir()


def two_packages(folder: Path) -> None:
    for name in ("one", "two"):
        copy_solution(STEP, folder / "ben" / name)


def two_submissions(folder: Path) -> None:
    (folder / "ben").mkdir()
    (folder / "ben.zip").touch()


def other_exercise(folder: Path) -> None:
    (folder / "ben" / "01-first-node").mkdir(parents=True)


def hidden(folder: Path) -> None:
    (folder / ".ben").mkdir()


def link(folder: Path) -> None:
    (folder / "ben").symlink_to("anna")


def test_the_archive_in_a_folder_is_named(tmp_path: Path) -> None:
    (tmp_path / "ben").mkdir()
    (tmp_path / "ben" / "work.zip").write_bytes(b"PK\x03\x04 and no more")
    (found,) = find_submissions([tmp_path], STEP, tmp_path / "out")
    refused = read(found, find_exercise(STEP), "ben")
    assert isinstance(refused, Refused)
    assert refused.reason.startswith("ben/work.zip is not a .zip or .tar.gz")


@pytest.mark.parametrize(
    ("make", "todo"),
    [(empty, "Hand in the folder of your package."), (two_packages, "Hand in the package to grade, for example ")],
)
def test_a_student_is_told_what_to_hand_in(tmp_path: Path, make: Callable[[Path], None], todo: str) -> None:
    make(tmp_path)
    (refused,) = (
        read(each, find_exercise(STEP), "ben") for each in find_submissions([tmp_path], STEP, tmp_path / "out")
    )
    assert isinstance(refused, Refused)
    assert todo in refused.reason
    assert "Give" not in refused.reason


def no_archive(folder: Path) -> None:
    (folder / "ben.zip").write_bytes(b"PK\x03\x04 and no more")


def leads_out(folder: Path) -> None:
    with zipfile.ZipFile(folder / "ben.zip", "w") as archive:
        archive.writestr("../package.xml", "<package/>")


def other_format(folder: Path) -> None:
    (folder / "ben.7z").write_bytes(b"7z")


def with_password(folder: Path) -> None:
    info = zipfile.ZipInfo("package.xml")
    with zipfile.ZipFile(folder / "ben.zip", "w") as archive:
        archive.writestr(info, "<package/>")
        info.flag_bits |= 1


def many_entries(folder: Path) -> None:
    with zipfile.ZipFile(folder / "ben.zip", "w") as archive:
        for number in range(unpack.MOST_ENTRIES + 1):
            archive.writestr(str(number), "")


def nested_too_deeply(folder: Path) -> None:
    with zipfile.ZipFile(folder / "ben.zip", "w") as archive:
        archive.writestr("a/" * (unpack.MOST_DEPTH + 1) + "package.xml", "<package/>")


def headers_of_headers(folder: Path) -> None:
    header = tarfile.TarInfo("a")
    header.type = tarfile.XHDTYPE
    (folder / "ben.tar").write_bytes(header.tobuf(tarfile.GNU_FORMAT) * 5000)


@pytest.mark.parametrize(
    ("make", "diagnosis"),
    [
        (empty, "no-package"),
        (two_packages, "several-packages"),
        (two_submissions, "several-submissions"),
        (other_exercise, "exercise-missing"),
        (hidden, "submission-name"),
        (link, "submission-link"),
        (no_archive, "archive-damaged"),
        (leads_out, "archive-damaged"),
        (other_format, "archive-format"),
        (with_password, "archive-format"),
        (many_entries, "submission-too-large"),
        (nested_too_deeply, "submission-too-large"),
        (headers_of_headers, "submission-too-large"),
    ],
)
def test_each_reason_has_its_own_diagnosis(tmp_path: Path, make: Callable[[Path], None], diagnosis: str) -> None:
    make(tmp_path)
    assert [each.diagnosis for each in refused(tmp_path)] == [diagnosis]


def refused(folder: Path) -> list[Refused]:
    contents = [
        read(each, find_exercise(STEP), each.student) for each in find_submissions([folder], STEP, folder / "grades")
    ]
    assert all(isinstance(each, Refused) for each in contents)
    return [each for each in contents if isinstance(each, Refused)]


def test_a_name_that_is_almost_the_exercise_has_a_diagnosis(tmp_path: Path) -> None:
    almost = tmp_path / "ben" / "03-Circle-Publisher"
    almost.mkdir(parents=True)
    (tmp_path / "ben" / "02-discover-topics").mkdir()
    found = find_submissions([tmp_path], None, tmp_path / "grades")
    assert [each.refused.diagnosis if each.refused else "" for each in found] == ["", "submission-name"]


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("anna", "Anna"),
        (unicodedata.normalize("NFC", "zoë"), unicodedata.normalize("NFD", "zoë")),
        ("ben li", "ben  li"),
        ("carl", "carl\N{ZERO WIDTH SPACE}"),
    ],
)
def test_names_that_differ_only_in_their_spelling_are_both_graded_and_marked(
    tmp_path: Path, one: str, other: str
) -> None:
    """Where students choose the names of their archives, one name must not cost another student all points."""
    copy_solution(STEP, tmp_path / one)
    before = order_of(tmp_path)
    for name in (other, "dora"):
        copy_solution(STEP, tmp_path / name)
    after = order_of(tmp_path)
    assert [each.refused for each in after.found] == [None, None, None]
    assert before.key(before.found[0]) != after.key(next(each for each in after.found if each.student == one))
    reports = {each.student: set_aside(after.task(each), "-").report for each in after.found}
    for name in (one, other):
        first = reports[name].outcomes[0]
        assert (first.finding.diagnosis, first.max) == ("similar-names", 0)
        assert tree.shown(one) in first.finding.observed
        assert tree.shown(other) in first.finding.observed
    attention = suspicions([(report, 1) for report in reports.values()])
    assert [bool(why) for why in attention] == [name != "dora" for name in reports]


def test_several_submissions_with_one_name_are_marked_for_the_instructor(tmp_path: Path) -> None:
    two_submissions(tmp_path)
    order = order_of(tmp_path, trusted=True)
    report = perform(order.task(order.found[0])).report
    assert suspicions([(report, 0)]) == ["there are several submissions with its name"]


def order_of(folder: Path, *, trusted: bool = False) -> Order:
    found = find_submissions([folder], STEP, folder / "grades")
    return Order(found, {}, sources_for(found, None), "none", trusted=trusted)


def test_names_with_different_bytes_that_are_not_utf8_are_different_students(tmp_path: Path) -> None:
    """A ZIP from an old Windows contains names in another encoding."""
    for name in ("J\udcf6rg", "J\udce4rg"):
        copy_solution(STEP, tmp_path / name)
    assert [each.refused for each in find_submissions([tmp_path], STEP, tmp_path / "grades")] == [None, None]


def test_the_class_page_counts_each_diagnosis_apart(tmp_path: Path) -> None:
    for make in (empty, no_archive):
        (tmp_path / make.__name__).mkdir()
        make(tmp_path / make.__name__)
    entries = []
    for folder in sorted(tmp_path.iterdir()):
        found = find_submissions([folder], STEP, folder / "grades")
        order = Order(found=found, roster={}, sources=sources_for(found, None), ros="none", trusted=True)
        entries.append(Entry(perform(order.task(found[0])).report, folder.name, ""))
    (check,) = failures(ClassReports(tuple(entries), ()).entries)
    assert {each.id: len(each.entries) for each in check.diagnoses} == {"no-package": 1, "archive-damaged": 1}
