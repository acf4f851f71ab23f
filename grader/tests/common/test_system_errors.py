from __future__ import annotations

import errno
import shutil
from typing import TYPE_CHECKING

import pytest

from grader.common.system_errors import of_the_machine, path_and_reason, refusal

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (OSError(errno.ENOSPC, "x", "/var/cache"), "The disk is full for /var/cache: free some space there"),
        (OSError(errno.EMFILE, "x", "/var/cache"), "`ulimit -n 4096`"),
        (BlockingIOError(errno.EAGAIN, "x"), "cannot start more processes for you"),
        (RuntimeError("can't start new thread"), "cannot start more processes for you"),
        (RuntimeError("epoll: Too many open files"), "`ulimit -n 4096`"),
        (RuntimeError("Resource temporarily unavailable"), "cannot start more processes for you"),
        (MemoryError(), "has no memory left"),
        (OSError(errno.ENOMEM, "x"), "has no memory left"),
        (
            PermissionError(errno.EPERM, "x", b"/dev/caf\xe9"),
            "(Operation not permitted): see the output of",
        ),
        (OSError(errno.EROFS, "x", 7), "The disk is read-only: use a folder on another disk"),
        (OSError(), "(no reason given)"),
        (FileNotFoundError(errno.ENOENT, "No usable temporary directory found in ['/tmp']"), "with TMPDIR"),
    ],
)
def test_a_failed_system_call_is_one_sentence_with_what_to_do(error: BaseException, said: str) -> None:
    sentence = refusal(error)
    assert sentence is not None
    assert said in sentence
    assert sentence.endswith(".")
    assert "\n" not in sentence


@pytest.mark.parametrize("error", [ValueError("x"), RuntimeError("x"), KeyError("x"), RecursionError()])
def test_an_error_of_our_own_code_is_not_a_refusal(error: BaseException) -> None:
    assert refusal(error) is None


def test_a_path_that_does_not_exist_is_not_a_fault_of_the_machine() -> None:
    assert of_the_machine(OSError(errno.ENOSPC, "x"))
    assert not of_the_machine(FileNotFoundError(errno.ENOENT, "x"))
    assert not of_the_machine(PermissionError(errno.EACCES, "x"))


def test_the_reason_of_a_folder_that_was_not_copied_is_that_of_its_first_file(tmp_path: Path) -> None:
    (tmp_path / "from").mkdir()
    (tmp_path / "from/gone").symlink_to(tmp_path / "nowhere")
    with pytest.raises(shutil.Error) as raised:
        shutil.copytree(tmp_path / "from", tmp_path / "to")
    assert path_and_reason(raised.value) == (f"{tmp_path}/to/gone", "No such file or directory")
    full = shutil.Error([("from/a", "to/a", "[Errno 28] No space left on device: 'to/a'")])
    assert str(refusal(full)).startswith("The disk is full: ")


def test_a_recursion_while_an_error_is_handled_is_told_as_that_error() -> None:
    recursion = RecursionError()
    recursion.__context__ = PermissionError(errno.EPERM, "x", "/tmp/grader-run")
    assert "for /tmp/grader-run (Operation not permitted)" in str(refusal(recursion))
