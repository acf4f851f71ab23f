from __future__ import annotations

import hashlib
import os
import stat
from pathlib import Path

import pytest

from grader.errors import MachineError, UsageError
from grader.submission.package import Submission, open_submission, write_copy
from grader.tests.submission.folder import ODD_NAMES, make


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
    with pytest.raises(UsageError, match="not a path inside a package"):
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
    with pytest.raises(MachineError, match=r"No space left on device\. Free some space"):
        write_copy(submission, tmp_path / "copy")
