"""The cost of a command, measured in a separate process, because benchmarks import the tests."""

from __future__ import annotations

import json
import subprocess

import pytest

from grader.common.interpreter import interpreter

MEASURE = """
import json, os, sys
from grader.benchmarks.cpu_group import cpu_group
from grader.benchmarks.measure import cost
with cpu_group() as group:
    counts = group.folder is not None
cpu_s = cost([sys.executable, "-c", sys.argv[1]]).cpu_s
print(json.dumps([counts, cpu_s, counts and group.folder.exists()]))
"""
NOT_WAITED_FOR = """
import os, signal, time
signal.signal(signal.SIGCHLD, signal.SIG_IGN)  # so no process waits for the child
reads, writes = os.pipe()
if os.fork() == 0:
    while time.process_time() < 0.3:
        pass
    os._exit(0)
os.close(writes)
os.read(reads, 1)
"""


def measured(code: str) -> subprocess.CompletedProcess[str]:
    start = interpreter("-c", MEASURE, code)
    return subprocess.run(start.argv, env=start.env, capture_output=True, text=True, check=False)


def test_the_cpu_time_of_a_process_counts_also_if_nobody_waits_for_it() -> None:
    done = measured(NOT_WAITED_FOR)
    assert done.returncode == 0, done.stderr
    counts, cpu_s, left = json.loads(done.stdout)
    if not counts:
        pytest.skip("a control group that counts CPU time cannot be created here")
    assert cpu_s >= 0.3
    assert not left


def test_a_command_that_fails_has_no_cost() -> None:
    done = measured("raise SystemExit(3)")
    assert "exited with code 3:" in done.stderr


def test_a_command_may_print_more_than_a_pipe_can_hold() -> None:
    done = measured("print('x' * 1_000_000)")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)[1] > 0
