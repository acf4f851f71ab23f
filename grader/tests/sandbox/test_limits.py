"""Resource limits, in a sandbox cell and outside of a cell."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from grader.sandbox import limits as of_limits
from grader.sandbox import process
from grader.sandbox.limits import MIB, Limits, limited
from grader.tests.case import ROOT
from grader.tests.waiting import HANG_S


def test_limits_alone_need_no_bubblewrap() -> None:
    done = subprocess.run(limited(["true"], Limits()), check=False)
    assert done.returncode == 0


def test_a_program_cannot_ignore_its_limit_on_cpu_time() -> None:
    """The soft limit is also the hard limit, at which the kernel sends SIGKILL instead of SIGXCPU."""
    ignores = "import signal\nsignal.signal(signal.SIGXCPU, signal.SIG_IGN)\nwhile True: pass"
    for code in (ignores, "while True: pass"):
        done = subprocess.run(limited([sys.executable, "-c", code], Limits(cpu_s=1)), check=False, timeout=HANG_S)
        assert done.returncode == -signal.SIGKILL, code


def test_limits_never_exceed_those_of_the_user() -> None:
    """Only root can raise a hard limit. For other users, prlimit would refuse to start the command."""
    code = "from grader.sandbox.limits import *; print(*limited([], Limits()))"
    command = ["prlimit", f"--fsize={100 * MIB}", "--nofile=512", "--", sys.executable, "-c", code]
    reported = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert f"--fsize={100 * MIB} " in reported
    assert "--nofile=512 " in reported
    assert f"--as={Limits().memory} " in reported


@pytest.mark.parametrize("option", ["--fsize=102400", f"--as={2100 * MIB}"])
def test_a_low_limit_of_the_user_does_not_keep_a_submission_from_being_graded(option: str) -> None:
    check = [str(Path(sys.prefix, "bin/grader")), "check", str(ROOT / "solutions/03-circle-publisher")]
    # Without this capability, root may not raise a limit either.
    as_others = ["setpriv", "--bounding-set=-sys_resource"] if os.geteuid() == 0 else []
    done = subprocess.run(["prlimit", option, "--", *as_others, *check], capture_output=True, text=True, check=False)
    assert "Passed: 100 of 100 points." in done.stdout, done.stdout + done.stderr


def test_too_little_memory_for_a_program_is_the_machines_fault() -> None:
    code = "from grader.sandbox.limits import *; require_memory()"
    command = ["prlimit", f"--as={1500 * MIB}", "--", sys.executable, "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert "MachineError: Each program may use at most 1500 MiB of address space" in done.stderr
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_too_few_processes_for_a_user_are_the_machines_fault() -> None:
    """Otherwise, a thread that the system refuses to start looks like a mistake of the node."""
    code = (
        "import os, threading, time\nfrom grader.sandbox.limits import *\nos.geteuid() or os.setuid(54321)\n"
        "for _ in range(3): threading.Thread(target=time.sleep, args=(600,), daemon=True).start()\nrequire_processes()"
    )

    def said(limit: int) -> str:
        command = ["prlimit", f"--nproc={limit}:", "--", sys.executable, "-c", code]
        return subprocess.run(command, capture_output=True, text=True, check=False).stderr

    mine = 0 if os.geteuid() == 0 else of_limits._threads_of_user()
    assert f"This user may run at most {mine + 130} processes and threads here, and" in (low := said(mine + 130))
    assert int(low.rpartition(", and ")[2].split()[0]) >= mine + 4
    assert "more: type `ulimit -u 4096`" in low
    assert said(4096) == ""


@pytest.mark.parametrize(
    ("code", "out_of"),
    [
        ("import subprocess\nall = [subprocess.Popen(['sleep', '600']) for _ in '0' * 40]\nall[0].wait()", "processes"),
        ("import time\nx = bytearray(b'1' * (300 << 20))\ntime.sleep(600)", "memory"),
    ],
)
def test_without_a_cell_the_grader_counts_the_total_of_all_processes(code: str, out_of: str) -> None:
    limits = Limits(processes=20, total_memory=100 * MIB)
    command = limited([sys.executable, "-c", code], limits)
    done = process.run(command, timeout_s=HANG_S, most_stdout=1000, most_stderr=1000, watch=limits)
    assert (done.out_of, done.timed_out) == (out_of, False)
