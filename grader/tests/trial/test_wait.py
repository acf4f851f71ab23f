from __future__ import annotations

import pytest

from grader.trial.wait import Wait, doubt, wait_of

EXECUTOR = Wait(1, "python3", "futex", timed=True)
WORKER = Wait(2, "python3", "futex", timed=False)
RUNNING = wait_of(3, "python3", ["running"])
NO_CALL = wait_of(3, "python3", ["-1", "0x7ffd", "0x7f00"])


@pytest.mark.parametrize("waits", [[EXECUTOR], [EXECUTOR, WORKER, RUNNING, NO_CALL], [WORKER], []])
def test_threads_that_wait_for_each_other_are_not_in_doubt(waits: list[Wait]) -> None:
    assert doubt(waits, 1) is None


@pytest.mark.parametrize(
    ("words", "why"),
    [
        ("230 0x1 0x0", "sleeps"),  # clock_nanosleep
        ("202 0x1 0x80 0x0 0x7ffd 0x0", "waits for wall time"),  # a second futex with a timeout
        ("202 0x1 0x80 0x0 0x0 0x0", None),
        ("0 0x5 0x7ffd 0x1", "not part of ROS 2"),  # read: for example, a pipe or a timer
        ("61 0xffffffff 0x0 0x0", "not part of ROS 2"),  # wait4
        ("34", "not part of ROS 2"),  # pause
        ("128 0x1 0x0 0x7ffd 0x8", "not part of ROS 2"),  # rt_sigtimedwait
    ],
)
def test_a_thread_that_waits_for_something_else_is_in_doubt(words: str, why: str | None) -> None:
    found = doubt([EXECUTOR, wait_of(4, "python3", words.split())], 1)
    assert found == why if why is None else found is not None and why in found


def test_the_only_wait_with_a_timeout_may_be_the_one_of_the_executor_but_not_in_poll() -> None:
    assert doubt([wait_of(1, "python3", ["7", "0x1", "0x1", "0x64"])], 1) is not None
    assert doubt([EXECUTOR, EXECUTOR], 2) is None
