from __future__ import annotations

import errno

import pytest

from grader.common.system_errors import of_the_machine, refusal


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
        (OSError(errno.EROFS, "x", 7), "The disk cannot be written to: "),
        (OSError(), "it gave no reason"),
    ],
)
def test_what_the_system_refuses_is_one_sentence_with_what_to_do(error: BaseException, said: str) -> None:
    sentence = refusal(error)
    assert sentence is not None
    assert said in sentence
    assert sentence.endswith(".")
    assert "\n" not in sentence


@pytest.mark.parametrize("error", [ValueError("x"), RuntimeError("x"), KeyError("x"), RecursionError()])
def test_what_our_own_code_raises_is_no_refusal(error: BaseException) -> None:
    assert refusal(error) is None


def test_a_path_that_does_not_exist_is_whoever_named_its_mistake() -> None:
    assert of_the_machine(OSError(errno.ENOSPC, "x"))
    assert not of_the_machine(FileNotFoundError(errno.ENOENT, "x"))
    assert not of_the_machine(PermissionError(errno.EACCES, "x"))
