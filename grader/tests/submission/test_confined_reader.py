"""The confinement of the process that reads the files of students: what it can open, change and start."""

from __future__ import annotations

import ctypes
import fcntl
import os
import platform
import resource
import signal
import socket
import struct
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.errors import UnreadableError
from grader.sandbox import bubblewrap
from grader.submission import reader
from grader.submission.reader import read
from grader.tests.case import ROOT
from grader.tests.lacking import need_reachable_python
from grader.tests.observed_host import USER

if TYPE_CHECKING:
    from collections.abc import Callable


FS_IOC_SETFLAGS, FS_NODUMP_FL = 0x40086602, 0x40


def landlocked() -> bool:
    """Return whether the kernel has Landlock. With Landlock, landlock_create_ruleset(2) returns a version number."""
    return bool(ctypes.CDLL(None).syscall(444, None, ctypes.c_size_t(0), 1) >= 1)


FORBIDDEN: dict[str, Callable[[Path], object]] = {
    "a program": lambda _: os.execv("/bin/true", ["true"]),
    "a process": lambda _: os.fork(),
    "another program": lambda _: subprocess.run(["/bin/true"], check=True),
    "a connection": lambda _: socket.socket(socket.AF_UNIX),
    "a signal": lambda _: os.kill(os.getppid(), signal.SIGUSR1),
    "a larger limit": lambda _: resource.setrlimit(resource.RLIMIT_CPU, (resource.RLIM_INFINITY,) * 2),
    "an empty file": lambda file: file.with_name("new").touch(),
    "a change": lambda file: file.open("r+"),
    "an end of a file": lambda file: os.truncate(file, 0),
    "a removal": lambda file: file.unlink(),
    "another name": lambda file: file.rename(file.with_name("new")),
    "a link": lambda file: file.with_name("new").symlink_to(file),
    "a folder": lambda file: file.with_name("new").mkdir(),
    "a mode": lambda file: file.chmod(0o777),
    "a date": lambda file: os.utime(file),
    "a lock": lambda file: fcntl.flock(file.open(), fcntl.LOCK_EX),
    "a lease": lambda file: fcntl.fcntl(file.open(), fcntl.F_SETLEASE, fcntl.F_RDLCK),
    "a flush": lambda file: os.fsync(file.open().fileno()),
    "a mark": lambda file: fcntl.ioctl(file.open(), FS_IOC_SETFLAGS, struct.pack("i", FS_NODUMP_FL)),
    "a place before others": lambda _: os.setpriority(os.PRIO_PROCESS, 0, -5),
}
"""Code that an attacker could run in this process through a hole in a parser."""


@pytest.mark.skipif(platform.machine() != "x86_64", reason="the filter is for x86-64")
@pytest.mark.parametrize("what", FORBIDDEN)
def test_it_cannot_do_anything_but_read(what: str, tmp_path: Path) -> None:
    def attempt(_: Path) -> str:
        try:
            FORBIDDEN[what](tmp_path / "a.txt")
        except (OSError, ValueError) as error:
            return str(error)
        return ""

    (tmp_path / "a.txt").write_text("as before")
    before = (tmp_path / "a.txt").stat()
    assert any(
        each in read(attempt, tmp_path)
        for each in ("Permission denied", "not permitted", "not allowed", "Inappropriate")
    )
    assert [path.name for path in tmp_path.iterdir()] == ["a.txt"]
    assert (tmp_path / "a.txt").stat().st_mode == before.st_mode
    assert (tmp_path / "a.txt").read_text() == "as before"


def test_it_can_read_and_start_threads(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("a text")

    def reads(_: Path) -> list[str]:
        with ThreadPoolExecutor(2) as pool:
            return [
                *pool.map(Path.read_text, [tmp_path / "a.txt"] * 3),
                str(resource.getrlimit(resource.RLIMIT_NOFILE)),
            ]

    assert read(reads, tmp_path)[:3] == ["a text"] * 3


def content(file: Path, *_: object) -> str:
    try:
        return file.read_text()
    except OSError as error:
        return str(error.strerror)


def content_of(path: str, *_: object) -> str:
    return content(Path(path))


def without_landlock(_: object) -> bool:
    return False


@pytest.fixture(params=["Landlock", "its own mounts"])
def _each_confinement(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Use Landlock, or the separate mounts that the reader uses on a kernel without Landlock."""
    if request.param != "Landlock":
        monkeypatch.setattr(reader, "allow_only_reading", without_landlock)
        if not bubblewrap.usable():
            pytest.skip("this user cannot create namespaces")
    elif not landlocked():
        pytest.skip("this kernel has no Landlock")


@pytest.mark.usefixtures("_each_confinement")
def test_it_can_read_only_what_it_was_called_with(tmp_path: Path) -> None:
    for name in ("theirs", "others"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "a.txt").write_text(name)
    (tmp_path / "theirs" / "link").symlink_to("../others/a.txt")
    (tmp_path / "way").symlink_to("theirs")
    theirs, others = tmp_path / "theirs", tmp_path / "others"
    assert read(content, theirs / "a.txt") == "theirs"
    assert read(content, tmp_path / "way" / "a.txt") == "theirs"
    assert read(lambda *_: content(theirs / "a.txt"), [theirs]) == "theirs"
    for path in (others / "a.txt", theirs / "link", Path("/etc/passwd"), Path(f"/proc/{os.getpid()}/environ")):
        assert read(content_of, str(path), theirs) in ("Permission denied", "No such file or directory")
    assert reader.is_confined()


@pytest.mark.usefixtures("_each_confinement")
def test_it_reads_a_relative_path_from_the_current_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "a.txt").write_text("theirs")
    (tmp_path / "b.txt").write_text("others")
    monkeypatch.chdir(tmp_path)
    assert read(content, Path("a/a.txt")) == "theirs"
    assert read(lambda _: content(Path("b.txt")), Path("a")) in ("Permission denied", "No such file or directory")


@pytest.mark.usefixtures("_each_confinement")
def test_it_changes_nothing_even_without_the_filter(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reader, "forbid_all_but_reading", bool)

    def attempt(folder: Path) -> str:
        try:
            (folder / "new").touch()
        except OSError as error:
            return str(error.strerror)
        return ""

    assert read(attempt, tmp_path) in ("Permission denied", "Read-only file system")
    assert list(tmp_path.iterdir()) == []


ORDINARY = """
from pathlib import Path
from grader.submission import reader
reader.allow_only_reading = lambda _: False
print(reader.is_confined(), reader.read(Path.read_text, Path("/etc/hostname")) == Path("/etc/hostname").read_text())
"""


@pytest.mark.skipif(os.geteuid() != 0, reason="the other tests already run as an ordinary user")
def test_an_ordinary_users_own_mounts_hide_other_files() -> None:
    if not bubblewrap.usable():
        pytest.skip("this user cannot create namespaces")
    need_reachable_python()
    become = ["setpriv", f"--reuid={USER}", f"--regid={USER}", "--clear-groups", "--inh-caps=-all", "--"]
    command = [*become, sys.executable, "-c", ORDINARY]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    assert done.stdout == "True True\n", done.stderr


def test_without_any_confinement_it_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reader, "allow_only_reading", without_landlock)
    monkeypatch.setattr(reader, "keep_only", without_landlock)
    assert not reader.is_confined()


@pytest.mark.parametrize("opens", [Path.read_text, Path.read_bytes, lambda path: os.open(path, os.O_RDONLY)])
def test_a_named_pipe_does_not_block_it(
    opens: Callable[[Path], object], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A named pipe in a submission does not block any step that reads files.

    In an earlier version, only the search for files was protected.
    """
    monkeypatch.setattr(reader, "TIMEOUT_S", 20.0)
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "link").symlink_to("pipe")
    for name in ("pipe", "link"):
        with pytest.raises(UnreadableError, match="named pipe"):
            read(opens, tmp_path / name)


def test_it_has_no_terminal() -> None:
    assert read(lambda: [Path(f"/proc/self/fd/{number}").readlink() for number in range(3)]) == [Path(os.devnull)] * 3
