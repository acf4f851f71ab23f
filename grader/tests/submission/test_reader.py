"""The process that reads the files of students: its limits and its results."""

from __future__ import annotations

import copyreg
import ctypes
import mmap
import os
import resource
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import pytest

from grader.checks.outcome import Finding, Status
from grader.errors import MachineError, TooLargeError, UnreadableError, UsageError
from grader.submission import reader
from grader.submission.reader import read
from grader.submission.where import Where
from grader.tests.case import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable


def add(one: int, other: int = 1) -> int:
    return one + other


def found() -> tuple[Finding, Path, frozenset[str], dict[str, bytes]]:
    return Finding(Status.FAILED, "seen", where=Where("a.py", 3)), Path("/x"), frozenset("ab"), {"a": b"b"}


def refuses() -> NoReturn:
    message = "not so"
    raise UsageError(message)


def breaks() -> NoReturn:
    message = "odd"
    raise KeyError(message)


def spins() -> NoReturn:
    while True:
        pass


def sleeps() -> None:
    time.sleep(600)


def hoards() -> int:
    return len(bytearray(2 * reader.MEMORY))


def nests() -> object:
    return nests()


def crashes() -> object:
    return ctypes.string_at(0)


def overflows() -> bytes:
    return bytes(reader.MOST_ANSWER)


def test_what_is_read_comes_back() -> None:
    assert read(add, 1, other=3) == 4
    assert read(found) == found()


def test_it_is_read_in_another_process_and_in_one_only() -> None:
    ours = os.getpid()
    theirs = read(os.getpid)
    inner, outer = read(lambda: (read(os.getpid), os.getpid()))
    assert theirs != ours
    assert inner == outer != ours


def test_errors_of_ours_come_back_and_others_are_the_submissions() -> None:
    with pytest.raises(UsageError, match="not so"):
        read(refuses)
    with pytest.raises(UnreadableError, match="KeyError"):
        read(breaks)
    with pytest.raises(UnreadableError, match="SIGSEGV"):
        read(crashes)


def test_a_module_that_is_not_installed_is_not_the_submissions_fault() -> None:
    with pytest.raises(MachineError, match="no_such_module is not installed"):
        read(import_module, "no_such_module")


@pytest.mark.parametrize("function", [hoards, nests, overflows, spins])
def test_what_takes_too_much_is_too_large(function: object, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reader, "CPU_S", 1)
    before = children()
    with pytest.raises(TooLargeError, match=r"too large to be read|nested too deeply"):
        read(function)  # type: ignore[arg-type]
    assert children() <= before


def test_a_child_that_waits_is_the_machines_fault(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reader, "TIMEOUT_S", 0.5)
    before = children()
    with pytest.raises(MachineError, match=r"could not be read within 0\.5 s, because the machine was too busy"):
        read(sleeps)
    assert children() <= before


@pytest.mark.parametrize("end", [lambda: os._exit(1), crashes, sleeps])
def test_a_child_that_ends_without_an_answer_is_started_once_more(
    end: Callable[[], object], monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = 0
    call = reader._called

    def called(function: Callable[[], object], readable: tuple[Path, ...]) -> tuple[bytes | None, int]:
        nonlocal calls
        calls += 1  # the child is a fork, so it knows the number of its call
        monkeypatch.setattr(reader, "TIMEOUT_S", 0.5 if end is sleeps and calls == 1 else 60.0)
        return call(function, readable)

    def ends_once() -> int:
        if calls == 1:
            end()
        return calls

    monkeypatch.setattr(reader, "_called", called)
    assert read(ends_once) == 2


@pytest.mark.parametrize("action", [signal.SIG_DFL, signal.SIG_IGN])
def test_a_child_that_computes_for_too_long_is_not_started_again(
    action: signal.Handlers, monkeypatch: pytest.MonkeyPatch
) -> None:
    """SIGXCPU can be ignored from the start: a process inherits this from its parent."""
    calls = mmap.mmap(-1, 1)  # shared with the children

    def counts() -> None:
        calls[0] += 1
        signal.signal(signal.SIGXCPU, action)
        spins()

    monkeypatch.setattr(reader, "CPU_S", 1)
    with pytest.raises(TooLargeError):
        read(counts)
    assert calls[0] == 1


def children() -> set[str]:
    """Return the child processes of this process, including those that have exited without being waited for."""
    found: set[str] = set()
    for task in Path("/proc/self/task").iterdir():
        with suppress(OSError):  # the thread has ended
            found |= set((task / "children").read_text().split())
    return found


def test_the_limits_are_of_the_child_alone() -> None:
    kinds = (resource.RLIMIT_AS, resource.RLIMIT_CPU, resource.RLIMIT_FSIZE)
    before = [resource.getrlimit(kind) for kind in kinds]
    inside = read(lambda: [resource.getrlimit(kind)[0] for kind in kinds])
    assert [resource.getrlimit(kind) for kind in kinds] == before
    assert inside[1:] == [reader.CPU_S, 0]
    assert reader.MEMORY < inside[0] < 64 * reader.MEMORY


def test_it_holds_no_descriptor_of_its_parents() -> None:
    with Path("/dev/null").open("rb"):
        assert (
            len(read(os.listdir, Path("/proc/self/fd"))) <= 5
        )  # the standard streams, its pipe, and the listing itself


def test_errors_come_back_whatever_others_have_made_of_pickling() -> None:
    copyreg.pickle(UsageError, lambda error: (eval, (repr(error),)))
    try:
        with pytest.raises(UsageError, match="not so"):
            read(refuses)
    finally:
        copyreg.dispatch_table.pop(UsageError)


def test_threads_read_at_the_same_time() -> None:
    read_by: list[int] = []
    threads = [threading.Thread(target=lambda: read_by.append(read(add, 1))) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert read_by == [2] * 8


@pytest.mark.parametrize("value", [os.system, Path.unlink, threading.Thread, lambda: 1])
def test_nothing_but_plain_data_is_taken(value: object) -> None:
    with pytest.raises(MachineError, match=r"cannot be sent|is invalid"):
        read(lambda: value)


def test_a_result_cannot_run_a_script_of_ours() -> None:
    # A hostile result can name any module of the grader, and the grader imports it to find the class.
    files = [file for file in (ROOT / "grader").rglob("*.py") if "tests" not in file.parts]
    assert [file for file in files if file.read_text("utf-8").endswith("\nmain()\n")] == []


SLOW_NUMPY = """
import numpy_test
numpy_test.begun.set()
numpy_test.forked.wait(0.3)
value = 5
"""
READ_MEANWHILE = """
import os, sys, threading
sys.modules["numpy_test"] = numpy_test = type(sys)("numpy_test")
numpy_test.begun, numpy_test.forked = threading.Event(), threading.Event()
os.register_at_fork(after_in_parent=numpy_test.forked.set)
from grader.common.lazy import load_numpy, np
from grader.submission import reader
reader.TIMEOUT_S = 10
threading.Thread(target=load_numpy).start()
numpy_test.begun.wait()
print(reader.read(lambda: np.value))
"""


def test_a_child_never_waits_for_an_import_of_its_parent(tmp_path: Path) -> None:
    (tmp_path / "numpy.py").write_text(SLOW_NUMPY)
    command = [sys.executable, "-c", f"import sys; sys.path.insert(0, {str(tmp_path)!r})\n{READ_MEANWHILE}"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    assert done.stdout == "5\n", done.stderr
