from __future__ import annotations

import hashlib
import os
import socket
import stat
from pathlib import Path

import pytest

from grader import tree
from grader.errors import MachineError, UsageError
from grader.submission import MAX_REJECTED, Submission, open_submission, write_copy


def make(folder: Path, files: dict[str, str | bytes]) -> Path:
    for path, data in files.items():
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(data.encode() if isinstance(data, str) else data)
    return folder


PACKAGE: dict[str, str | bytes] = {
    "package.xml": "<package/>",
    "setup.py": "",
    "pkg/__init__.py": "",
    "pkg/node.py": "x = 1\n",
}


@pytest.fixture
def package(tmp_path: Path) -> Path:
    return make(tmp_path / "ws" / "pkg", PACKAGE)


def test_a_package_folder_is_the_submission(package: Path) -> None:
    submission = open_submission(package)
    assert submission.name == str(package)
    assert submission.package_dir == package.resolve()
    assert submission.files == {path: str(data).encode() for path, data in PACKAGE.items()}
    assert submission.rejected == ()


def test_a_folder_around_one_package_is_the_submission_too(package: Path) -> None:
    around = open_submission(package.parent.parent)
    assert around.package_dir == package.resolve()
    assert around.files == open_submission(package).files
    assert around.digest == open_submission(package).digest


@pytest.mark.parametrize("path", [".", "pkg/..", "pkg/"])
def test_the_name_is_the_users_and_the_folder_is_absolute(
    package: Path, path: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(package)
    if path == "pkg/":
        monkeypatch.chdir(package.parent)
    submission = open_submission(path)
    assert submission.name == path
    assert submission.package_dir == package.resolve()


@pytest.mark.parametrize("only", ["package.xml", "setup.py"])
def test_one_of_the_two_files_makes_a_package(tmp_path: Path, only: str) -> None:
    make(tmp_path, {f"src/one/{only}": ""})
    assert open_submission(tmp_path).package_dir == (tmp_path / "src/one").resolve()


def test_what_lies_below_a_package_belongs_to_it(package: Path) -> None:
    make(package / "copy", PACKAGE)
    submission = open_submission(package.parent)
    assert submission.package_dir == package.resolve()
    assert "copy/package.xml" in submission.files


@pytest.mark.parametrize(
    "other", ["build/pkg", "install/pkg/share/pkg", "log/latest", ".git/x", "venv", "__pycache__", "ignored"]
)
def test_what_tools_leave_behind_holds_no_package(package: Path, other: str) -> None:
    make(package.parent / other, {"package.xml": "", "setup.py": ""})
    make(package.parent, {"venv/pyvenv.cfg": "", "ignored/COLCON_IGNORE": ""})
    assert open_submission(package.parent).package_dir == package.resolve()


@pytest.mark.parametrize(
    "folder", ["build", "install", "log", ".vscode", "env", "pkg/__pycache__", "pkg.egg-info", "pkg/log"]
)
def test_what_tools_leave_behind_is_no_file_of_the_package(package: Path, folder: str) -> None:
    make(package / folder, {"a.py": "", "b/c.txt": ""})
    make(package, {"env/pyvenv.cfg": ""})
    submission = open_submission(package)
    assert set(submission.files) == set(PACKAGE)
    assert submission.rejected == ()


def test_a_python_package_may_be_called_log(package: Path) -> None:
    make(package, {"pkg/log/__init__.py": "", "pkg/log/a.py": "", ".flake8": ""})
    assert {"pkg/log/__init__.py", "pkg/log/a.py", ".flake8"} <= set(open_submission(package).files)


def refused(path: Path | str) -> str:
    with pytest.raises(UsageError) as caught:
        open_submission(path)
    assert caught.value.exit_code == 2
    return str(caught.value)


def test_no_such_folder_names_the_part_that_exists(tmp_path: Path) -> None:
    message = refused(tmp_path / "nope" / "pkg")
    assert f"no folder {tmp_path}/nope/pkg" in message
    assert f"right as far as {tmp_path}" in message


def test_a_path_through_a_file_is_no_folder(package: Path) -> None:
    assert "no folder" in refused(package / "setup.py" / "x")


def test_a_node_file_is_answered_with_its_package(package: Path) -> None:
    message = refused(package / "pkg" / "node.py")
    assert "node.py is a file" in message
    assert message.endswith(f"give its folder: {package.resolve()}.")


def test_an_archive_is_to_be_unpacked(tmp_path: Path) -> None:
    make(tmp_path, {"work.zip": "PK"})
    assert "Unpack it" in refused(tmp_path / "work.zip")


def test_a_link_to_nowhere_is_named(tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to("gone")
    assert "link to a place that does not exist" in refused(tmp_path / "link")


def test_no_package_says_what_is_there(tmp_path: Path) -> None:
    make(tmp_path, {"draw_circle.py": "", "notes/a.txt": ""})
    message = refused(tmp_path)
    assert message.startswith("There is no package in ")
    assert "It holds draw_circle.py, notes/." in message


def test_an_empty_folder_is_called_empty(tmp_path: Path) -> None:
    assert "empty" in refused(tmp_path)


def test_inside_of_the_package_the_folder_around_is_proposed(package: Path) -> None:
    assert refused(package / "pkg").endswith(f"The folder around it, {package.resolve()}, is one: give that.")


@pytest.mark.parametrize("name", ["Package.xml", "package.xml.txt", "SETUP.PY"])
def test_a_name_that_is_nearly_right_is_named(tmp_path: Path, name: str) -> None:
    make(tmp_path, {f"pkg/{name}": ""})
    message = refused(tmp_path)
    assert f"pkg/{name} is nearly one" in message


def test_a_linked_package_is_named_and_not_followed(tmp_path: Path, package: Path) -> None:
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "pkg").symlink_to(package)
    message = refused(tmp_path / "mine")
    assert "pkg is a link" in message


def test_a_folder_that_colcon_ignores_is_named(tmp_path: Path) -> None:
    make(tmp_path / "pkg", {**PACKAGE, "COLCON_IGNORE": ""})
    assert "COLCON_IGNORE" in refused(tmp_path)
    assert open_submission(tmp_path / "pkg").files  # named outright, it is what the user wants


def test_several_packages_are_listed(tmp_path: Path) -> None:
    for name in ("two", "one"):
        make(tmp_path / "src" / name, PACKAGE)
    message = refused(tmp_path)
    assert f"holds 2 packages: {tmp_path}/src/one, {tmp_path}/src/two." in message
    assert message.endswith(f"for example {tmp_path}/src/one.")


def test_too_many_folders_end_the_search(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("grader.package_search.MAX_FOLDERS", 3)
    make(tmp_path, {f"{number}/a": "" for number in range(4)})
    assert "more than 3 folders" in refused(tmp_path)


@pytest.mark.parametrize(
    ("target", "why"),
    [
        ("../../secret.txt", "outside the package"),
        ("pkg/../../secret.txt", "outside the package"),
        ("/etc/passwd", "one machine only"),
        ("gone.txt", "no file of the package"),
        ("pkg", "no file of the package"),
        ("itself", "no file of the package"),
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


def test_pipes_and_sockets_are_rejected_and_never_waited_for(package: Path) -> None:
    os.mkfifo(package / "pipe")
    with socket.socket(socket.AF_UNIX) as server:
        server.bind(os.path.relpath(package / "socket"))
        rejected = open_submission(package).rejected
    assert [line.split(" is ")[0] for line in rejected] == ["pipe", "socket"]


def test_a_file_swapped_for_a_link_is_not_read(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    make(package.parent, {"secret.txt": "secret"})
    before = tree._read_file

    def swap(found: tree.Tree, folder: int, entry: tree.Entry, path: str) -> None:
        if path == "setup.py":
            (package / "setup.py").unlink()
            (package / "setup.py").symlink_to("../secret.txt")
        before(found, folder, entry, path)

    monkeypatch.setattr(tree, "_read_file", swap)
    submission = open_submission(package)
    assert "setup.py" not in submission.files
    assert submission.rejected == ("setup.py changed while it was read.",)


def test_a_folder_swapped_for_a_link_is_not_entered(package: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    outside = make(package.parent / "outside", {"node.py": "secret"})
    before = tree._read_below

    def swap(found: tree.Tree, folder: int, entry: tree.Entry, path: str, depth: int) -> None:
        (package / "pkg").rename(package / "moved")
        (package / "pkg").symlink_to(outside)
        before(found, folder, entry, path, depth)

    monkeypatch.setattr(tree, "_read_below", swap)
    assert b"secret" not in open_submission(package).files.values()


def test_an_unreadable_file_is_rejected(package: Path) -> None:
    (package / "setup.py").chmod(0)
    (package / "pkg").chmod(0)
    rejected = rejected_as_nobody(package) if os.geteuid() == 0 else "|".join(open_submission(package).rejected)
    (package / "pkg").chmod(0o755)
    forbidden = "may not be read (its permissions forbid it)."
    assert rejected == f"pkg {forbidden}|setup.py {forbidden}"


def rejected_as_nobody(package: Path) -> str:
    """To root nothing is unreadable, so look at it as somebody else, from inside: the folders above may be closed."""
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


ODD_NAMES = ["with blank.py", "café.py", "cafe\u0301.py", "日本.txt", "Node.py", "node.py", "-rf", "*", "'\""]


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
    assert submission.rejected == (f"{shown} has a name with control characters, or one that is not UTF-8.",)


def test_contents_are_bytes_and_kept_as_they_are(package: Path) -> None:
    contents = b"\xef\xbb\xbfx = 1\r\ny = '\xff'\r\n"
    (package / "pkg" / "node.py").write_bytes(contents)
    assert open_submission(package).files["pkg/node.py"] == contents


@pytest.mark.parametrize(
    ("limit", "value", "why"),
    [
        ("MAX_FILE_BYTES", 9, "more than the 9 that a file may have"),
        ("MAX_TOTAL_BYTES", 12, "beyond the 12 bytes"),
        ("MAX_FILES", 3, "beyond the 3 files"),
        ("MAX_PATH_BYTES", 14, "more than 14 bytes"),
        ("MAX_DEPTH", 0, "more than 0 folders deep"),
        ("MAX_ENTRIES", 4, "more than the 4 entries"),
    ],
)
def test_limits_leave_out_and_say_so(
    package: Path, monkeypatch: pytest.MonkeyPatch, limit: str, value: int, why: str
) -> None:
    monkeypatch.setattr(tree, limit, value)
    submission = open_submission(package)
    assert any(why in line for line in submission.rejected)
    assert set(submission.files) < set(PACKAGE)


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


def test_the_digest_is_that_of_paths_and_contents(package: Path) -> None:
    whole = b"11:package.xml10:<package/>15:pkg/__init__.py0:11:pkg/node.py6:x = 1\n8:setup.py0:"
    assert open_submission(package).digest == hashlib.sha256(whole).hexdigest()


def test_the_digest_forgets_times_permissions_and_what_is_left_out(package: Path) -> None:
    before = open_submission(package).digest
    make(package, {"build/x": "", "pkg/__pycache__/node.pyc": ""})
    (package / "setup.py").chmod(0o755)
    os.utime(package / "setup.py", (0, 0))
    assert open_submission(package).digest == before
    (package / "setup.py").write_text(" ")
    assert open_submission(package).digest != before


def test_a_copy_is_the_submission_again(package: Path, tmp_path: Path) -> None:
    for name in ODD_NAMES:
        (package / name).write_text(name)
    (package / "setup.py").chmod(0o700)
    before = os.umask(0o077)
    try:
        write_copy(open_submission(package), tmp_path / "a" / "copy")
    finally:
        os.umask(before)
    copy = open_submission(tmp_path / "a" / "copy")
    assert copy.files == open_submission(package).files
    assert copy.executable == {"setup.py"}
    modes = {path.name: stat.S_IMODE(path.stat().st_mode) for path in (tmp_path / "a" / "copy").rglob("*")}
    assert (modes["setup.py"], modes["package.xml"], modes["pkg"]) == (0o755, 0o644, 0o755)


@pytest.mark.parametrize("path", ["../out", "/tmp/out", "a/../../out", "a//b", "./a", ""])
def test_a_copy_stays_in_its_folder(tmp_path: Path, path: str) -> None:
    submission = Submission("x", tmp_path, {path: b""}, (), "")
    with pytest.raises(UsageError, match="no path inside a package"):
        write_copy(submission, tmp_path / "copy")
    assert not (tmp_path / "out").exists()


def test_a_copy_needs_a_new_folder(package: Path) -> None:
    with pytest.raises(MachineError, match="new folder"):
        write_copy(open_submission(package), package)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
def test_a_full_disk_is_the_machines_fault(package: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = os.open

    def full(path: str | Path, flags: int, mode: int = 0o777, *, dir_fd: int | None = None) -> int:
        return before("/dev/full", os.O_WRONLY) if flags & os.O_EXCL else before(path, flags, mode, dir_fd=dir_fd)

    submission = open_submission(package)
    monkeypatch.setattr(os, "open", full)
    with pytest.raises(MachineError, match=r"No space left on device\. Make room"):
        write_copy(submission, tmp_path / "copy")


def test_no_descriptor_stays_open(package: Path) -> None:
    open_submission(package)
    before = len(os.listdir("/proc/self/fd"))  # noqa: PTH208 (a listing opens one itself)
    for _ in range(3):
        open_submission(package)
    assert len(os.listdir("/proc/self/fd")) == before  # noqa: PTH208


def test_hundreds_of_files_are_read(package: Path) -> None:
    make(package, {f"pkg/part{number // 50}/file{number}.py": "x = 1\n" * 50 for number in range(500)})
    assert len(open_submission(package).files) == 504
