"""A crash before Ctrl-C is a crash, however long the process takes to exit."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.evidence.late_exit import with_crash_first
from grader.tests.checks.made import every, recording
from grader.trial.recording import Output, ProcessEnd

UNCAUGHT = """\
Traceback (most recent call last):
  File "/ws/install/my_robot_controller/lib/my_robot_controller/draw_circle", line 33, in <module>
    sys.exit(load_entry_point())
ZeroDivisionError: division by zero
"""
CAUGHT = UNCAUGHT.replace("in <module>", "in send")
INTERRUPTED = ProcessEnd(by="SIGINT", exit_code=0, t_s=10.1, stop_s=0.1)


@pytest.mark.parametrize(
    ("stderr", "at_s", "by"),
    [(UNCAUGHT, 0.5, "itself"), (UNCAUGHT, 10.0, "SIGINT"), (CAUGHT, 0.5, "SIGINT"), ("", 0.5, "SIGINT")],
    ids=["uncaught", "after Ctrl-C", "printed by the node", "nothing"],
)
def test_an_uncaught_exception_before_ctrl_c_ended_the_node(stderr: str, at_s: float, by: str) -> None:
    output = Output(stderr, times=(at_s,) * len(stderr.splitlines()))
    given = replace(recording(every(0.5, 2.0, 1.0)), end=INTERRUPTED, sigint_t_s=10.0, stderr=output)
    end = with_crash_first(given).end
    assert end.by == by
    assert end.t_s == (at_s if by == "itself" else INTERRUPTED.t_s)
