"""The state of threads is read from /proc, so these tests examine real processes."""

from __future__ import annotations

import os
from contextlib import closing

import pytest

from grader.tests.descriptors import descriptors
from grader.tests.trial.program import python
from grader.tests.waiting import until
from grader.trial.rest import GoneError, Threads, receives

WAITS_ON_A_LINE = "import sys; print('ready', flush=True); sys.stdin.readline(); print('woken', flush=True); "


def until_asleep(threads: Threads) -> None:
    until(lambda: threads.look().asleep)


def test_a_process_that_waits_rests_and_two_looks_are_equal() -> None:
    with python(WAITS_ON_A_LINE) as process, closing(Threads(process.pid)) as threads:
        until_asleep(threads)
        until(lambda: threads.look() == threads.look())  # a thread that is just falling asleep is counted once more


def test_a_process_that_ran_between_two_looks_shows_it_though_it_sleeps_in_both() -> None:
    with python(WAITS_ON_A_LINE + "sys.stdin.readline()") as process, closing(Threads(process.pid)) as threads:
        assert process.stdin is not None
        assert process.stdout is not None
        until_asleep(threads)
        until(lambda: threads.look().runs == threads.runs())
        before, runs = threads.look(), threads.runs()
        process.stdin.write("\n")
        process.stdin.flush()
        assert process.stdout.readline() == "woken\n"
        until_asleep(threads)
        assert before.counted
        assert threads.look() != before
        assert threads.runs() != runs


def test_a_busy_process_does_not_rest() -> None:
    with python("print('ready', flush=True)\nwhile True: pass") as process, closing(Threads(process.pid)) as threads:
        assert not any(threads.look().asleep for _ in range(100))
        assert not threads.main_asleep()


def test_a_second_thread_counts() -> None:
    busy = "import threading, sys\ndef work():\n while True: pass\nthreading.Thread(target=work, daemon=True).start()\n"
    with python(busy + "print('ready', flush=True)\nsys.stdin.readline()") as process:
        with closing(Threads(process.pid)) as threads:
            until(lambda: "system call 0" in {wait.call for wait in threads.waits() if wait.tid == process.pid})
        for _ in range(100):
            with closing(Threads(process.pid)) as threads:
                assert not threads.look().asleep


@pytest.mark.parametrize(
    ("wait", "call", "timed"),
    [
        ("time.sleep(600)", "clock_nanosleep", True),
        ("threading.Event().wait(600)", "futex", True),
        ("threading.Event().wait()", "futex", False),
        ("select.select([], [], [], 600)", "select", True),
        ("p = select.poll(); p.poll()", "poll", False),
        ("p = select.poll(); p.poll(600_000)", "poll", True),
    ],
)
def test_what_a_thread_waits_for_is_reported(wait: str, call: str, timed: bool) -> None:
    code = f"import select, threading, time\nprint('ready', flush=True)\n{wait}"
    with python(code) as process, closing(Threads(process.pid)) as threads:
        until_asleep(threads)
        (main,) = (each for each in threads.waits() if each.tid == process.pid)
        assert (main.call.removeprefix("p").removesuffix("6"), main.timed) == (call.removeprefix("p"), timed)


def test_threads_of_fast_dds_are_left_out_but_never_the_main_thread() -> None:
    named = "open(f'/proc/self/task/{threading.get_native_id()}/comm', 'w').write('dds.udp')"
    code = (
        f"import sys, threading, time\ndef work():\n {named}\n named.set()\n time.sleep(60)\n"
        "named = threading.Event()\nthreading.Thread(target=work, daemon=True).start()\nnamed.wait()\n"
        f"{named}\nprint('ready', flush=True)\nsys.stdin.readline()"
    )
    with python(code) as process, closing(Threads(process.pid)) as threads:
        until_asleep(threads)
        assert len(threads.look().runs) == 2
        assert [wait.tid for wait in threads.waits()] == [process.pid]


@pytest.mark.parametrize(
    ("thread", "reported"), [("dds.udp.7410", True), ("dds.shm.7411", True), ("dds.ev.0", False), ("python3", False)]
)
def test_messages_come_through_the_threads_of_fast_dds_but_not_through_its_timers(thread: str, reported: bool) -> None:
    assert receives(thread) == reported


def test_a_name_of_a_thread_need_not_be_text() -> None:
    code = "open('/proc/self/comm', 'wb').write(b'\\xff) R (')\nprint('ready', flush=True)\ninput()"
    with python(code) as process, closing(Threads(process.pid)) as threads:
        until_asleep(threads)
        assert [wait.tid for wait in threads.waits()] == [process.pid]


def test_the_end_of_a_process_is_reported() -> None:
    with python(WAITS_ON_A_LINE) as process, closing(Threads(process.pid)) as threads:
        before = threads.runs()
        assert before
        process.kill()
        process.wait()
        assert threads.runs() == ()
        with pytest.raises(GoneError):
            threads.look()


def test_the_files_of_a_process_that_has_ended_are_closed() -> None:
    with python(WAITS_ON_A_LINE) as process:
        process.kill()
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)  # the process is a zombie until it is waited for
        before = descriptors()
        with pytest.raises(GoneError):
            Threads(process.pid)
        assert descriptors() == before
