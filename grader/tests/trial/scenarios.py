"""What tests of a trial run where rclpy is (in_ros.py)."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

from grader.trial.wall import WallTrial


def a_line_while_the_graph_is_looked_at() -> list[float]:
    """When a line is taken in that the node writes during the last look before the clock starts (s)."""
    written: list[str] = []
    taken_in_s: list[float] = []

    def read(now_s: float) -> None:
        taken_in_s.extend([now_s] * len(written))
        written.clear()

    stage: Any = WallTrial.__new__(WallTrial)
    stage.node = SimpleNamespace(ended=lambda: False, read_output=read)
    stage.recorder = SimpleNamespace(commands=[], follow_graph=lambda: written.append("a line"))
    stage.spin = lambda _=0.0: []
    stage.students_nodes = lambda: ["/draw_circle"]
    stage._discover()
    return taken_in_s


def a_node_that_drives_before_it_is_found() -> int:
    """How many of its commands have come when the clock starts."""
    commands: list[str] = []
    stage: Any = WallTrial.__new__(WallTrial)
    stage.node = SimpleNamespace(ended=lambda: False, read_output=lambda _: 0)
    stage.recorder = SimpleNamespace(commands=commands, follow_graph=lambda: True)
    stage.spin = lambda _=0.0: commands.append("a command")
    stage.students_nodes = lambda: ["/draw_square"]
    stage._discover()
    return len(commands)
