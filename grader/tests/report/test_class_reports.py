"""One file of one student never prevents the page of the class, and a file that is left out is named."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING

import pytest

from grader.report import class_reports
from grader.report.class_reports import MOST_LINES, ClassReports, read_class
from grader.report.html_class import MOST_LEFT_OUT, class_page
from grader.report.json import from_json, to_data
from grader.tests.report.reports import report

if TYPE_CHECKING:
    from pathlib import Path

    from grader.report.report import Report


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Return a folder with the reports of two students."""
    for name in ("anna", "ben"):
        _write(tmp_path / f"{name}.json", name)
    return tmp_path


def _write(file: Path, name: str, size: int = 0) -> None:
    data = to_data(report("passed", submission=name))
    data["outcomes"][0]["seen"] = "x" * size
    file.write_text(json.dumps(data), "utf-8")


def _names(reports: ClassReports) -> list[str]:
    return [entry.name for entry in reports.entries]


def test_a_report_that_is_too_large_is_named_and_the_others_are_read(folder: Path) -> None:
    _write(folder / "carl.json", "carl", class_reports.LARGEST)
    reports = read_class(folder)
    assert _names(reports) == ["anna", "ben"]
    assert reports.lines == ["Left out: carl.json: it has 4.0 MB, and a report has at most 4 MB."]
    assert "it has 4.0 MB" in class_page(reports)


def test_two_hundred_large_reports_do_not_prevent_the_page(folder: Path) -> None:
    for number in range(200):
        _write(folder / f"{number:03}.json", f"{number:03}", 2_000_000)
    reports = read_class(folder)
    assert {"anna", "ben"} <= set(_names(reports))
    assert 30 < len(_names(reports)) < 60
    assert len(_names(reports)) + len(reports.left_out) == 202
    assert reports.lines[0].endswith("it has 2.0 MB, and the smaller reports already have more than 100 MB.")
    assert len(reports.lines) == MOST_LINES + 1
    assert reports.lines[-1] == f"Left out: {len(reports.left_out) - MOST_LINES} more, see the page."


def test_the_size_of_each_report_that_is_left_out_is_named(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name, value in (("MOST_BYTES", 0), ("MOST_AT_ONCE", 2)):
        monkeypatch.setattr(class_reports, name, value)
    _write(folder / "carl.json", "carl", 1_000_000)
    _write(folder / "dora.json", "dora", 2_000_000)
    of_others = "and the smaller reports already have more than 0 MB."
    assert read_class(folder).lines == [
        f"Left out: carl.json: it has 1.0 MB, {of_others}",
        f"Left out: dora.json: it has 2.0 MB, {of_others}",
    ]


@pytest.mark.parametrize("harm", [os.abort, lambda: bytearray(4 * 1024**3)], ids=["crash", "memory"])
def test_a_report_that_stops_the_reading_process_is_named(
    folder: Path, monkeypatch: pytest.MonkeyPatch, harm: object
) -> None:
    def reads(text: str) -> Report:
        found = from_json(text)
        if found.submission == "carl":
            assert callable(harm)
            harm()
        return found

    for name in ("carl", "dora", "ed"):
        _write(folder / f"{name}.json", name)
    monkeypatch.setattr(class_reports, "from_json", reads)
    reports = read_class(folder)
    assert _names(reports) == ["anna", "ben", "dora", "ed"]
    assert [name for name, _ in reports.left_out] == ["carl.json"]
    assert len(reports.lines) == 1


def test_a_pipe_a_broken_link_and_bytes_that_are_not_utf_8_are_named(folder: Path) -> None:
    os.mkfifo(folder / "pipe.json")
    (folder / "gone.json").symlink_to("nowhere")
    (folder / "loop.json").symlink_to("loop.json")
    (folder / "bytes.json").write_bytes(b'{"outcomes": "\xff"}')
    (folder / "folder.json").mkdir()
    reports = read_class(folder)
    assert _names(reports) == ["anna", "ben"]
    said = dict(reports.left_out)
    assert said.keys() == {"pipe.json", "gone.json", "loop.json", "bytes.json"}
    assert "not a regular file" in said["pipe.json"]
    assert "No such file" in said["gone.json"]
    assert "symbolic links" in said["loop.json"]
    assert "utf-8" in said["bytes.json"]


def test_a_reason_and_a_name_are_short_and_cannot_control_the_terminal(folder: Path) -> None:
    data = to_data(report("passed"))
    data["outcomes"][0]["status"] = "\x1b" * 1_000_000
    (folder / "a\x1bb.json").write_text(json.dumps(data))
    (line,) = read_class(folder).lines
    assert "\x1b" not in line
    assert len(line) < 400


def test_a_folder_with_too_many_files_does_not_hide_the_reports_above_it(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(class_reports, "MOST_FOUND", 50)
    (folder / "below").mkdir()
    for number in range(100):
        (folder / "below" / f"{number}.txt").touch()
    reports = read_class(folder)
    assert _names(reports) == ["anna", "ben"]
    assert reports.lines == ["Left out: below: the search for reports ended here, after 50 files and folders."]


def test_a_path_that_is_too_long_is_left_out(folder: Path) -> None:
    deep = folder.joinpath(*["d" * 200] * 6)
    deep.mkdir(parents=True)
    (deep / "a.json").write_text("{}")
    (line,) = read_class(folder).lines
    assert line.endswith("its path has more than 1000 bytes.")
    assert len(line) < 400


def test_the_page_lists_a_bounded_number_of_files() -> None:
    left_out = tuple((f"{number}.json", "it is damaged") for number in range(MOST_LEFT_OUT + 5))
    page = class_page(ClassReports((), left_out))
    assert page.count("it is damaged") == MOST_LEFT_OUT
    assert "5 more files were left out" in page


def test_the_command_prints_the_files_that_were_left_out(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from grader.cli import class_page as command

    _write(folder / "carl.json", "carl", class_reports.LARGEST)
    command(folder)
    printed = capsys.readouterr()
    assert "Left out: carl.json" in printed.err
    assert printed.out.startswith("The class page:")
