from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from grader.errors import UsageError
from grader.report import output_file

SOLUTION = Path(output_file.__file__).parents[2] / "solutions/03-circle-publisher"


@pytest.mark.parametrize("there", [True, False])
def test_a_file_that_may_not_be_written_is_named_before_any_work(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, there: bool
) -> None:
    file = tmp_path / "report.json"
    if there:
        file.touch()
    output_file.check_writable(file)
    asked: list[Path] = []
    monkeypatch.setattr(os, "access", lambda path, _: asked.append(path))
    with pytest.raises(UsageError, match=r"report\.json cannot be written: Permission denied\."):
        output_file.check_writable(file)
    assert asked == [file if there else tmp_path]


def test_a_pipe_of_a_student_is_not_waited_for(tmp_path: Path) -> None:
    file = tmp_path / "report.json"
    os.mkfifo(file)
    with pytest.raises(UsageError, match=r"report\.json is a pipe or a socket that no program reads\."):
        output_file.write(file, b"{}")
    reads = os.open(file, os.O_RDONLY | os.O_NONBLOCK)
    output_file.write(file, b"{}")
    assert os.read(reads, 10) == b"{}"
    os.close(reads)


def test_a_dash_is_not_a_file_name() -> None:
    with pytest.raises(UsageError, match=r"cannot be -, since the command prints its own text on standard output\."):
        output_file.check_writable(Path("-"))


def test_a_full_disk_behind_a_file_does_not_hide_the_verdict() -> None:
    command = [str(Path(sys.prefix, "bin/grader")), "check", str(SOLUTION), "--json", "/dev/full"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert "Passed: 100 of 100 points." in done.stdout
    assert "/dev/full cannot be written: No space left on device." in done.stderr
    assert done.returncode == 3


@pytest.mark.parametrize("there", [True, False])
def test_a_link_in_the_folder_of_a_student_is_not_followed(tmp_path: Path, *, there: bool) -> None:
    file, link = tmp_path / ".bashrc", tmp_path / "report.json"
    if there:
        file.write_text("of the instructor")
    link.symlink_to(file)
    with pytest.raises(UsageError, match=r"report\.json is a symbolic link"):
        output_file.check_writable(link)
    with pytest.raises(UsageError, match=r"report\.json is a symbolic link"):
        output_file.write(link, b"forged")
    assert file.exists() == there
    assert not there or file.read_text() == "of the instructor"


def test_the_links_of_the_system_are_followed(tmp_path: Path) -> None:
    output_file.check_writable(Path("/dev/stdout"))
    with (tmp_path / "report.json").open("wb") as opened:
        output_file.write(Path(f"/dev/fd/{opened.fileno()}"), b"{}")
    assert (tmp_path / "report.json").read_bytes() == b"{}"
