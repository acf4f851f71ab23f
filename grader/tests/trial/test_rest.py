"""The state of threads is read from /proc, so these tests examine real processes."""

from __future__ import annotations

import os
import threading
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.common.process_stat import has_exited, stat_fields
from grader.tests.descriptors import descriptors
from grader.tests.trial.program import python
from grader.tests.waiting import until
from grader.trial.node_group import cpu_ns_at_rest
from grader.trial.rest import GoneError, Threads, not_of_dds, receives

if TYPE_CHECKING:
    from collections.abc import Callable

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
        until(lambda: threads.look() == threads.look())
        before, cpu_ns = threads.look(), threads.cpu_ns()
        assert threads.asleep()
        assert threads.cpu_ns() == cpu_ns
        process.stdin.write("\n")
        process.stdin.flush()
        assert process.stdout.readline() == "woken\n"
        until(threads.asleep)
        assert before.counted
        assert threads.look() != before
        assert threads.cpu_ns() > cpu_ns


def test_the_work_of_every_thread_of_another_process_counts_even_of_one_that_has_ended() -> None:
    code = (
        "import sys, threading\ndef work():\n for _ in range(1000): pass\n"
        "print('ready', flush=True)\nsys.stdin.readline()\nthread = threading.Thread(target=work)\n"
        "thread.start()\nthread.join()\nprint('worked', flush=True)\nsys.stdin.readline()"
    )
    with python(code) as process, closing(Threads(process.pid, receives)) as threads:
        assert process.stdin is not None
        assert process.stdout is not None
        before, before_s = threads.cpu_ns(), threads.run_time_s()
        assert len(before) == 1
        process.stdin.write("\n")
        process.stdin.flush()
        assert process.stdout.readline() == "worked\n"
        assert threads.cpu_ns() > before
        assert threads.run_time_s() > before_s


def test_of_this_process_only_the_observed_threads_count() -> None:
    name, go_on, worked, end = "dds.udp.1", threading.Event(), threading.Event(), threading.Event()

    def work() -> None:
        Path(f"/proc/self/task/{threading.get_native_id()}/comm").write_text(name)
        worked.set()
        go_on.wait()
        worked.set()
        end.wait()

    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    assert worked.wait(60)
    worked.clear()
    with closing(Threads(os.getpid(), receives)) as threads:
        until(threads.asleep)  # this thread runs, but it is not observed
        before = threads.cpu_ns()
        assert len(before) == 1
        assert threads.only(before, receives) == before
        assert threads.only(before, not_of_dds) == ()
        assert threads.cpu_ns() == before
        go_on.set()
        assert worked.wait(60)
        until(threads.asleep)
        assert threads.cpu_ns() > before
    end.set()
    thread.join()


def test_a_busy_process_does_not_rest() -> None:
    with python("print('ready', flush=True)\nwhile True: pass") as process, closing(Threads(process.pid)) as threads:
        assert not any(threads.look().asleep or threads.asleep() for _ in range(100))
        assert not threads.main_asleep()


class HeldUp(Threads):
    """A process that is woken just after it was looked at, and whose CPU time is not counted yet."""

    wake: Callable[[], object]
    looks = 0

    def asleep(self) -> bool:
        found = super().asleep()
        self.looks += 1
        if self.looks == 1:
            self.wake()
        return found

    def cpu_ns(self) -> tuple[int, ...]:
        return (0,)


def test_a_process_that_is_woken_just_after_a_look_is_not_at_rest() -> None:
    code = "import sys; print('ready', flush=True); sys.stdin.readline(); print('woken', flush=True)\nwhile True: pass"
    with python(code) as process, closing(HeldUp(process.pid)) as threads:
        assert process.stdin is not None
        assert process.stdout is not None
        stdin, stdout = process.stdin, process.stdout

        def wake() -> None:
            stdin.write("\n")
            stdin.flush()
            assert stdout.readline() == "woken\n"

        threads.wake = wake
        until(threads.main_asleep)
        assert cpu_ns_at_rest(threads) is None
        assert threads.looks == 2


def test_processes_at_rest_have_their_cpu_times() -> None:
    with python(WAITS_ON_A_LINE) as process, closing(Threads(process.pid)) as threads:
        until(lambda: cpu_ns_at_rest(threads, threads) is not None)
        assert cpu_ns_at_rest(threads, threads) == [threads.cpu_ns()] * 2


def test_a_second_thread_counts() -> None:
    busy = "import threading, sys\ndef work():\n while True: pass\nthreading.Thread(target=work, daemon=True).start()\n"
    with python(busy + "print('ready', flush=True)\nsys.stdin.readline()") as process:
        with closing(Threads(process.pid)) as threads:
            until(lambda: "system call 0" in {wait.call for wait in threads.waits() if wait.tid == process.pid})
        for _ in range(100):
            with closing(Threads(process.pid)) as threads:
                assert not threads.look().asleep
                assert not threads.asleep()


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
        until(lambda: threads.cpu_ns() == threads.cpu_ns())
        process.kill()
        process.wait()
        assert threads.cpu_ns() != threads.cpu_ns()
        with pytest.raises(GoneError):
            threads.look()
        with pytest.raises(GoneError):
            threads.asleep()


def test_a_process_whose_main_thread_has_exited_rests_and_ends_with_its_last_thread() -> None:
    code = (
        "import ctypes, threading\nprint('ready', flush=True)\n"
        "threading.Thread(target=input).start()\nctypes.CDLL(None).pthread_exit(None)"
    )
    with python(code) as process, closing(Threads(process.pid)) as threads:
        until(lambda: Path(f"/proc/{process.pid}/stat").read_text().split()[2] == "Z")
        until_asleep(threads)
        assert threads.asleep()
        assert threads.main_asleep()
        assert not has_exited(stat_fields(Path(f"/proc/{process.pid}/stat").read_bytes()))
        process.kill()
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
        assert has_exited(stat_fields(Path(f"/proc/{process.pid}/stat").read_bytes()))
        with pytest.raises(GoneError):
            threads.asleep()


def test_the_files_of_a_process_that_has_ended_are_closed() -> None:
    with python(WAITS_ON_A_LINE) as process:
        process.kill()
        os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)  # the process is a zombie until it is waited for
        before = descriptors()
        with pytest.raises(GoneError):
            Threads(process.pid)
        assert descriptors() == before
