"""Made-up log lines of a node, and the finding about their format."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.subjects.log import LOG_LINES
from grader.tests.checks.made import NODE, NODE_FILE, evidence, found, recording, submission
from grader.trial.recording import LogLine, Output

if TYPE_CHECKING:
    from grader.checks.outcome import Finding

HELLO = "Hello {counter}"
POINTS = "x={x:.2f}"
RATE = {"rate_hz": 1.0, "tolerance_percent": 5.0, "min_interval_s": 0.85, "max_interval_s": 1.2}
OTHER_FORM = "The words are right, but the numbers are missing or have the wrong format."
LOGS = NODE.replace("self.publisher.publish(msg)", 'self.get_logger().info("...")')


def lines(*texts: str, every_s: float = 1.0, logger: str = "my_first_node") -> tuple[LogLine, ...]:
    return tuple(LogLine(every_s * (index + 1), "INFO", logger, text) for index, text in enumerate(texts))


def hello(*numbers: int) -> tuple[LogLine, ...]:
    return lines(*(f"Hello {number}" for number in numbers))


def in_format(log: tuple[LogLine, ...], format_: str = HELLO, node: str = LOGS, stdout: str = "") -> Finding:
    trial = recording([], log=log, stdout=Output(stdout))
    return found(LOG_LINES, evidence(trial, submission({NODE_FILE: node})), format=format_)
