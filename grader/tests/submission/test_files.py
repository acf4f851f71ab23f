from __future__ import annotations

import os
import socket
from typing import TYPE_CHECKING

import pytest

from grader.errors import MachineError
from grader.submission import reader, tree
from grader.submission.package import MAX_REJECTED, open_submission
from grader.tests.descriptors import descriptors
from grader.tests.submission.folder import ODD_NAMES, PACKAGE, make

if TYPE_CHECKING:
    from pathlib import Path


def test_a_python_package_may_be_called_log(package: Path) -> None:
    make(package, {"pkg/log/__init__.py": "", "pkg/log/a.py": "", ".flake8": ""})
    assert {"pkg/log/__init__.py", "pkg/log/a.py", ".flake8"} <= set(open_submission(package).files)


@pytest.mark.parametrize(
    "folder", ["build", "install", "log", ".vscode", "env", "pkg/__pycache__", "pkg.egg-info", "pkg/log"]
)
def test_what_tools_leave_behind_is_no_file_of_the_package(package: Path, folder: str) -> None:
    make(package / folder, {"a.py": "", "b/c.txt": ""})
    make(package, {"env/pyvenv.cfg": ""})
    submission = open_submission(package)
    assert set(submission.files) == set(PACKAGE)
    assert submission.rejected == ()


@pytest.mark.parametrize(
    ("target", "why"),
    [
        ("../../secret.txt", "outside the package"),
        ("pkg/../../secret.txt", "outside the package"),
        ("/etc/passwd", "can differ on another machine"),
        ("gone.txt", "not a file of the package"),
        ("pkg", "not a file of the package"),
        ("itself", "not a file of the package"),
    ],
)
def test_a_link_that_leads_nowhere_good_is_rejected(package: Path, target: str, why: str) -> None:
    make(package.parent.parent, {"secret.txt": "secret"})
    (package / "itself").symlink_to(target)
    submission = open_submission(package)
    assert set(submission.files) == set(PACKAGE)
    assert len(submission.rejected) == 1
    assert submission.rejected[0].startswith("itself is a link to")
    assert why in submission.rejected[0]


def test_a_linked_folder_is_not_entered(package: Path) -> None:
    outside = make(package.parent.parent / "outside", {"a.py": ""})
    (package / "more").symlink_to(outside)
    submission = open_submission(package)
    assert set(submission.files) == set(PACKAGE)
    assert submission.rejected[0].startswith("more is a link to")


def test_links_to_files_of_the_package_are_those_files(package: Path) -> None:
    (package / "pkg" / "again.py").symlink_to("../pkg/node.py")
    (package / "pkg" / "and_again.py").symlink_to("again.py")
    (package / "pkg" / "node.py").chmod(0o755)
    submission = open_submission(package)
    assert submission.files["pkg/and_again.py"] == b"x = 1\n"
    assert submission.executable == {"pkg/node.py", "pkg/again.py", "pkg/and_again.py"}
    assert submission.rejected == ()


def test_links_in_a_ring_end(package: Path) -> None:
    (package / "a").symlink_to("b")
    (package / "b").symlink_to("a")
    assert [line.split()[0] for line in open_submission(package).rejected] == ["a", "b"]


def test_pipes_and_sockets_are_rejected_and_never_waited_for(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    os.mkfifo(package / "pipe")
    monkeypatch.chdir(package)  # the path of a socket must be short
    with socket.socket(socket.AF_UNIX) as server:
        server.bind("socket")
        rejected = open_submission(package).rejected
    assert [line.split(" is ")[0] for line in rejected] == ["pipe", "socket"]


def _may_write(monkeypatch: pytest.MonkeyPatch) -> None:
    """Allow the reading process to change files, because these tests replace a file there."""
    monkeypatch.setattr(reader, "forbid_all_but_reading", lambda: None)
    monkeypatch.setattr(reader, "allow_only_reading", lambda _: True)


def test_a_file_swapped_for_a_link_is_not_read(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    make(package.parent, {"secret.txt": "secret"})
    before = tree._read_file

    def swap(found: tree.Tree, folder: int, entry: tree.Entry, path: str) -> None:
        if path == "setup.py":
            (package / "setup.py").unlink()
            (package / "setup.py").symlink_to("../secret.txt")
        before(found, folder, entry, path)

    _may_write(monkeypatch)
    monkeypatch.setattr(tree, "_read_file", swap)
    submission = open_submission(package)
    assert "setup.py" not in submission.files
    assert submission.rejected == ("setup.py changed while it was being read.",)


def test_a_folder_swapped_for_a_link_is_not_entered(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    outside = make(package.parent / "outside", {"node.py": "secret"})
    before = tree._read_below

    def swap(found: tree.Tree, folder: int, entry: tree.Entry, path: str, depth: int) -> None:
        (package / "pkg").rename(package / "moved")
        (package / "pkg").symlink_to(outside)
        before(found, folder, entry, path, depth)

    _may_write(monkeypatch)
    monkeypatch.setattr(tree, "_read_below", swap)
    assert b"secret" not in open_submission(package).files.values()


def test_an_unreadable_file_is_rejected(package: Path) -> None:
    (package / "setup.py").chmod(0)
    (package / "pkg").chmod(0)
    rejected = rejected_as_nobody(package) if os.geteuid() == 0 else "|".join(open_submission(package).rejected)
    (package / "pkg").chmod(0o755)
    forbidden = "cannot be read because of its permissions."
    assert rejected == f"pkg {forbidden}|setup.py {forbidden}"


def rejected_as_nobody(package: Path) -> str:
    """Read the package as an ordinary user, since root may read everything. Return `rejected`."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.chdir(package)
            os.setuid(65534)
            os.write(writing, "|".join(open_submission(".").rejected).encode())
        finally:
            os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as pipe:
        text = pipe.read()
    os.waitpid(child, 0)
    return text


def test_a_fault_of_the_disk_is_no_fault_of_the_student(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = os.open

    def fail(path: str, flags: int, *args: object, **more: object) -> int:
        if path == "setup.py":
            raise OSError(5, "Input/output error", path)
        return before(path, flags, *args, **more)  # type: ignore[arg-type]

    monkeypatch.setattr(os, "open", fail)
    with pytest.raises(MachineError, match=r"setup\.py could not be read"):
        open_submission(package)


def test_odd_names_are_kept_letter_by_letter(package: Path) -> None:
    for name in ODD_NAMES:
        (package / name).write_text(name)
    submission = open_submission(package)
    assert {name: submission.files[name].decode() for name in ODD_NAMES} == {name: name for name in ODD_NAMES}
    assert submission.rejected == ()


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        (b"caf\xe9.py", r"caf\xe9.py"),
        (b"line\r\nbreak.py", r"line\r\nbreak.py"),
        (b"\x1b[31mred", r"\x1b[31mred"),
        ("a\u202egnp.py".encode(), r"a\u202egnp.py"),
    ],
)
def test_names_that_cannot_be_printed_are_rejected_in_characters_that_can(
    package: Path, name: bytes, shown: str
) -> None:
    (package / os.fsdecode(name)).write_bytes(b"")
    submission = open_submission(package)
    assert set(submission.files) == set(PACKAGE)
    assert submission.rejected == (
        f"{shown} has a name with characters that cannot be printed, or one that is not UTF-8.",
    )


def test_contents_are_bytes_and_kept_as_they_are(package: Path) -> None:
    contents = b"\xef\xbb\xbfx = 1\r\ny = '\xff'\r\n"
    (package / "pkg" / "node.py").write_bytes(contents)
    assert open_submission(package).files["pkg/node.py"] == contents


@pytest.mark.parametrize(
    ("limit", "value", "why"),
    [
        ("MAX_FILE_BYTES", 9, "a file may have at most 9"),
        ("MAX_TOTAL_BYTES", 12, "beyond the limit of 12 bytes"),
        ("MAX_FILES", 3, "beyond the limit of 3 files"),
        ("MAX_PATH_BYTES", 14, "more than 14 bytes"),
        ("MAX_DEPTH", 0, "more than 0 folders deep"),
        ("MAX_ENTRIES", 4, "beyond the limit of 4 files and folders"),
    ],
)
def test_limits_leave_out_and_say_so(
    package: Path, monkeypatch: pytest.MonkeyPatch, limit: str, value: int, why: str
) -> None:
    monkeypatch.setattr(tree, limit, value)
    submission = open_submission(package)
    assert any(why in line for line in submission.rejected)
    assert set(submission.files) < set(PACKAGE)


def test_a_folder_with_too_many_entries_is_left_out(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tree, "MAX_ENTRIES", 4)
    for number in range(5):
        (package / "pkg" / f"{number}.txt").write_text("")
    assert open_submission(package).rejected == ("pkg is beyond the limit of 4 files and folders.",)


def test_links_count_towards_the_limits(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tree, "MAX_TOTAL_BYTES", 50)
    for number in range(9):
        (package / f"link{number}").symlink_to("package.xml")
    submission = open_submission(package)
    assert sum(map(len, submission.files.values())) <= 50
    assert len(submission.rejected) == 6


def test_of_many_rejected_only_some_are_named(package: Path) -> None:
    for number in range(MAX_REJECTED + 5):
        (package / f"{number:02}").symlink_to("/")
    rejected = open_submission(package).rejected
    assert len(rejected) == MAX_REJECTED + 1
    assert rejected[-1] == "And 5 more."


def test_no_descriptor_stays_open(package: Path) -> None:
    open_submission(package)
    before = len(descriptors())
    for _ in range(3):
        open_submission(package)
    assert len(descriptors()) <= before  # an object of an earlier test may have been closed


def test_hundreds_of_files_are_read(package: Path) -> None:
    make(package, {f"pkg/part{number // 50}/file{number}.py": "x = 1\n" * 50 for number in range(500)})
    assert len(open_submission(package).files) == 504
