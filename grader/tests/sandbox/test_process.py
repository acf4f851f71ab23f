from __future__ import annotations

import os
import sys
import time

import pytest

from grader.sandbox.limits import Limits
from grader.sandbox.process import Finished, run
from grader.sandbox.usage import Guard
from grader.tests.waiting import HANG_S


def python(code: str, *, stdin: bytes = b"", timeout_s: float = HANG_S, most: int = 1_000_000) -> Finished:
    return run([sys.executable, "-c", code], stdin=stdin, timeout_s=timeout_s, most_stdout=most, most_stderr=2_000)


def test_input_output_and_exit_code() -> None:
    done = python("import sys; sys.stderr.write('e'); print(sys.stdin.read()[::-1]); sys.exit(3)", stdin=b"abc")
    assert (done.exit_code, done.stdout, done.stderr) == (3, b"cba\n", b"e")


def test_megabytes_of_input_and_output_do_not_block() -> None:
    data = bytes(range(256)) * 20_000
    done = python("import sys; sys.stdout.buffer.write(sys.stdin.buffer.read())", stdin=data, most=10_000_000)
    assert done.stdout == data


def test_a_child_that_does_not_read_its_input_is_not_an_error() -> None:
    assert python("pass", stdin=b"x" * 1_000_000).exit_code == 0


def test_a_child_that_never_ends_is_ended_with_its_children() -> None:
    timeout_s, begun = 0.5, b""
    while begun != b"!" * 2:  # on a busy machine, the time may be over before the two processes have begun
        timeout_s *= 2.0
        ours, theirs = os.pipe()
        code = f"import os\nos.fork()\nos.write({theirs}, b'!')\nwhile True: pass"
        argv = [sys.executable, "-c", code]
        done = run(argv, timeout_s=timeout_s, most_stdout=1, most_stderr=2_000, pass_fds=(theirs,))
        os.close(theirs)
        with os.fdopen(ours, "rb") as pipe:
            begun = pipe.read()  # until no process is left
        assert done.timed_out


def test_a_child_that_closes_its_output_but_does_not_end_is_ended() -> None:
    done = python("import os, time; os.close(1); os.close(2); time.sleep(1000)", timeout_s=1.0)
    assert done.timed_out


def test_too_much_output_ends_the_child() -> None:
    done = python("while True: print('x' * 1000)")
    assert done.too_much
    assert not done.timed_out


def test_the_beginning_and_the_end_of_a_long_log_are_kept() -> None:
    done = python("import sys; sys.stderr.write('begin' + 'x' * 1_000_000 + 'end')")
    assert done.stderr.startswith(b"begin")
    assert done.stderr.endswith(b"end")
    assert b"998008 bytes left out" in done.stderr
    assert len(done.stderr) < 3_000


@pytest.mark.parametrize(
    ("waited_s", "timed_out"), [(0.0, True), (60.0, False)], ids=["the machine is idle", "the machine is crowded"]
)
def test_waiting_for_a_processor_does_not_count(
    monkeypatch: pytest.MonkeyPatch, waited_s: float, *, timed_out: bool
) -> None:
    monkeypatch.setattr(Guard, "waited_s", lambda _: waited_s)
    monkeypatch.setattr("grader.sandbox.process.MOST_TIME", 1000)
    program = ["sleep", "1000" if timed_out else "1"]
    done = run(program, timeout_s=0.3, most_stdout=100, most_stderr=100, watch=Limits())
    assert done.timed_out == timed_out


def test_a_child_on_a_crowded_machine_is_ended_after_three_times_its_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Guard, "waited_s", lambda _: 1e6)
    begun = time.monotonic()
    done = run(["sleep", "1000"], timeout_s=0.2, most_stdout=100, most_stderr=100, watch=Limits())
    assert done.timed_out
    assert time.monotonic() - begun >= 0.6


def test_processes_gain_no_time_by_keeping_the_processors_busy(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("grader.sandbox.process.MOST_TIME", HANG_S)
    busy = "for number in 1 2 3 4 5 6 7 8; do while :; do :; done & done; wait"
    done = run(["sh", "-c", busy], timeout_s=1.0, most_stdout=100, most_stderr=100, watch=Limits())
    assert done.timed_out
    assert done.seconds < HANG_S
