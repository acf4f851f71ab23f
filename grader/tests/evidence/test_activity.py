"""A recording shows whether a node that exited on its own had started."""

from __future__ import annotations

import pytest

from grader.evidence.activity import START_S, ended_at_start
from grader.tests.checks.made import graph, recording
from grader.trial.recording import Output, ProcessEnd

IN_INIT = """\
Traceback (most recent call last):
  File "/ws/my_robot_controller/draw_circle.py", line 28, in main
  File "/ws/my_robot_controller/draw_circle.py", line 17, in __init__
TypeError: Node.get_logger() takes 1 positional argument but 2 were given
"""
IN_MAIN = IN_INIT.replace("in __init__", "in main")
IN_SPIN = IN_INIT.replace(
    "  File", '  File "/lib/rclpy/executors.py", line 111, in await_or_execute\n    return callback()\n  File', 1
)
LATE_S = START_S + 0.3


@pytest.mark.parametrize(
    ("stderr", "t_s", "at_start"),
    [
        (IN_INIT, LATE_S, True),  # on a busy machine, the constructor runs after the initial period
        (IN_MAIN, LATE_S, False),
        ("", LATE_S, False),
        (IN_MAIN, 0.0, True),
        (IN_SPIN, LATE_S, False),
        (IN_SPIN, 0.0, False),
    ],
)
def test_an_exception_in_a_constructor_is_a_failed_start_however_late_it_comes(
    stderr: str, t_s: float, at_start: bool
) -> None:
    end = ProcessEnd(by="itself", exit_code=1, t_s=t_s, stop_s=None)
    assert ended_at_start(recording([], end=end, stderr=Output(stderr))) is at_start


def test_a_node_that_sent_a_command_had_started() -> None:
    end = ProcessEnd(by="itself", exit_code=1, t_s=LATE_S, stop_s=None)
    assert not ended_at_start(recording([(0.1, 2.0, 1.0)], end=end, stderr=Output(IN_INIT)))


@pytest.mark.parametrize(
    ("exit_code", "nodes", "at_start"),
    [(0, 0, True), (0, 1, False), (1, 0, False)],
)
def test_a_program_that_ended_without_a_node_had_not_started_however_late_it_is_noticed(
    exit_code: int, nodes: int, *, at_start: bool
) -> None:
    end = ProcessEnd(by="itself", exit_code=exit_code, t_s=LATE_S, stop_s=None)
    graphs = tuple(graph() for _ in range(nodes))
    assert ended_at_start(recording([], end=end, graphs=graphs)) is at_start
