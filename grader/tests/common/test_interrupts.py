"""A signal that stops a command interrupts no `__init__` of rclpy, and is not lost."""

from __future__ import annotations

import signal
import subprocess
import sys

import pytest

from grader.common.interpreter import interpreter
from grader.common.interrupts import stops_deferred

DISCARDED_AT_A_FORK = """
import os, signal, time
from grader.common.interrupts import raise_lost_stops

raise_lost_stops()
os.register_at_fork(before=lambda: signal.raise_signal(signal.SIGINT), after_in_parent=lambda: AFTER)
try:
    if not os.fork():
        os._exit(0)
    time.sleep(100)
except KeyboardInterrupt:
    print("interrupted", signal.getitimer(signal.ITIMER_REAL), signal.getsignal(signal.SIGALRM) == signal.SIG_DFL)
"""
NODE_INTERRUPTED = """
import signal
import rclpy.executors
from grader.graph.discovery import cli_node


def guard_condition(*_):
    signal.raise_signal(signal.SIGINT)
    return real(*_)


real = rclpy.executors.SignalHandlerGuardCondition
rclpy.executors.SignalHandlerGuardCondition = guard_condition
try:
    with cli_node():
        print("not interrupted")
except KeyboardInterrupt:
    print("interrupted", rclpy.ok())
"""
TASK_INTERRUPTED = """
import signal, sys
from rclpy.task import Future
from grader.common.interrupts import raise_lost_stops


def interrupt(frame, *_):
    if frame.f_code is Future.__init__.__code__:
        signal.raise_signal(signal.SIGINT)


raise_lost_stops()
sys.settrace(interrupt)
try:
    Future()
except KeyboardInterrupt:
    print("interrupted")
"""


def outcome_of(code: str) -> tuple[int, str, str]:
    start = interpreter("-c", code, python=sys.executable, searches=True)
    done = subprocess.run(start.argv, env=start.env, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


def interrupted(done: list[str], error: type[Exception] | None = None) -> None:
    with stops_deferred():
        signal.raise_signal(signal.SIGINT)
        done.append("all of it")
        if error:
            raise error


def test_a_signal_waits_until_the_context_has_been_left() -> None:
    done: list[str] = []
    with pytest.raises(KeyboardInterrupt):
        interrupted(done)
    assert done == ["all of it"]
    assert signal.getsignal(signal.SIGINT) == signal.default_int_handler


def test_an_error_in_the_context_does_not_hide_the_signal() -> None:
    with pytest.raises(KeyboardInterrupt):
        interrupted([], ValueError)


def test_signals_that_terminate_the_process_or_are_ignored_keep_their_handlers() -> None:
    with stops_deferred():
        assert signal.getsignal(signal.SIGTERM) == signal.SIG_DFL


def test_an_interrupt_that_python_discards_at_a_fork_is_raised_again_and_nothing_is_printed() -> None:
    code = DISCARDED_AT_A_FORK.replace("AFTER", "1 / 0")
    assert outcome_of(code) == (0, "interrupted (0.0, 0.0) True\n", "")


def test_an_interrupt_that_python_discards_twice_is_raised_again() -> None:
    """On a busy machine, the fork may take so long that the interrupt is raised again in a callback."""
    code = DISCARDED_AT_A_FORK.replace("AFTER", "time.sleep(50)")
    assert outcome_of(code) == (0, "interrupted (0.0, 0.0) True\n", "")


def test_an_interrupt_is_not_raised_where_python_would_discard_it_a_third_time() -> None:
    """On a busy machine, it may be time to raise it while another discarded exception is being handled."""
    alarm = "signal.raise_signal(signal.SIGALRM) if frame.f_code.co_name == 'discard' else None"
    code = DISCARDED_AT_A_FORK.replace("AFTER", f"(sys.settrace(lambda frame, *_: {alarm}), 1 / 0)")
    assert outcome_of(f"import sys{code}") == (0, "interrupted (0.0, 0.0) True\n", "")


def test_ctrl_c_while_a_commands_node_is_created_prints_nothing_and_the_node_is_removed() -> None:
    assert outcome_of(NODE_INTERRUPTED) == (0, "interrupted False\n", "")


def test_ctrl_c_while_rclpy_creates_a_task_prints_nothing() -> None:
    assert outcome_of(TASK_INTERRUPTED) == (0, "interrupted\n", "")


def test_another_error_in_a_finalizer_is_printed() -> None:
    code = "from grader.common.interrupts import raise_lost_stops\nraise_lost_stops()\n"
    code += "class Broken:\n    def __del__(self):\n        raise ValueError('broken')\nBroken()"
    returncode, stdout, stderr = outcome_of(code)
    assert (returncode, stdout, "ValueError: broken" in stderr) == (0, "", True)
