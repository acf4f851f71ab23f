"""The results of running a student's tests, in memory and as JSON."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from grader.common.json_types import number, text, whole_or_none

MOST_MESSAGE = 1500
"""The maximum length of a pytest message (characters)."""
LATEST_S = 1e9
"""The maximum time (s) that is stored for a node's clock. A clock that a test advances does not get this far, so a
clock at the maximum follows the system time."""


@dataclass(frozen=True)
class NodeEvents:
    """What happened to the node that was created last in a run, usually by the failing test.

    The grader counts these values from the requests of the student's process.
    """

    poses: int = 0
    """The number of poses that the node received."""
    calls: int = 0
    """The number of times that the callback of its timer ran."""
    commands: int = 0
    """The number of commands that the node published."""
    first_s: float | None = None
    """The time (s) of the node's clock at the first event, at most LATEST_S. None if there was no event."""
    clock_s: float | None = None
    """The time (s) of the node's clock at the last event, at most LATEST_S. None if there was no event."""
    all_calls: int = 0
    """The number of times that the callbacks of the timers ran, in all nodes of the run together."""


@dataclass(frozen=True)
class NodeRun:
    """One run of all tests. `node` is the id of the broken node, or "" for the correct node.

    `exit_code` is the exit code of pytest, or None if the run did not finish on its own. `collected`, `passed` and
    `skipped` are numbers of tests. `test` (a name), `message`, `file`, `line` and `outcome` describe the first test
    that failed. `outcome` is what failed: the test itself ("failed"), a fixture ("setup" or "teardown") or the import
    of its file ("import"). A student's process may have changed all values except `node`, `over` and `seconds`.
    Therefore, only the success or failure of a run counts, and only in combination with the other runs.
    """

    node: str
    exit_code: int | None
    over: bool = False
    """Whether the run exceeded its time limit."""
    seconds: float = 0.0
    collected: int = 0
    passed: int = 0
    skipped: int = 0
    test: str = ""
    outcome: str = ""
    message: str = ""
    file: str = ""
    line: int = 0
    events: NodeEvents | None = None
    """What happened to the node that was created last. The value is None if the run created no node, and in old
    recordings."""

    @property
    def accepted(self) -> bool:
        """Whether pytest ended with exit code 0: it found tests, and none of them failed."""
        return self.exit_code == 0


@dataclass(frozen=True)
class BenchResult:
    """The runs on the correct node and on the broken nodes.

    Runs that were not started (see `take` in grader.testbench.bench) are left out.
    """

    runs: tuple[NodeRun, ...]
    seconds: float = 0.0

    @cached_property
    def right(self) -> tuple[NodeRun, ...]:
        """The runs on the correct node."""
        return tuple(run for run in self.runs if not run.node)

    def of(self, node: str) -> NodeRun | None:
        """Return the run on this broken node, or None if there was no such run."""
        return next((run for run in self.runs if run.node == node), None)


@dataclass(frozen=True)
class Ended:
    """The data about a run that has ended. The report of the run (JSON) has not been parsed yet.

    A student's process could have written the report.
    """

    node: str
    exit_code: int | None = None
    over: bool = False
    seconds: float = 0.0
    report: bytes = b""
    stuck: bool = False
    """Whether the run was stuck: all of its threads waited for each other without a time limit (see patience.py)."""
    events: NodeEvents | None = None
    """What the grader has counted during the run."""


def run_of(ended: Ended) -> NodeRun:
    """Parse the report of an ended run, and return all data about the run as a NodeRun.

    Parts of the report that have an unexpected form are ignored.
    """
    try:
        report = json.loads(ended.report)
    except (ValueError, RecursionError):
        report = None
    report = report if isinstance(report, dict) else {}
    listed = report.get("cases")
    cases = [case for case in listed if isinstance(case, dict)] if isinstance(listed, list) else []
    bad = next((case for case in cases if case.get("outcome") not in ("passed", "skipped")), {})
    return NodeRun(
        node=ended.node,
        exit_code=ended.exit_code,
        over=ended.over,
        seconds=ended.seconds,
        collected=int(_number(report.get("collected"))),
        passed=sum(case.get("outcome") == "passed" for case in cases),
        skipped=sum(case.get("outcome") == "skipped" for case in cases),
        test=_text(bad.get("name")),
        outcome=_text(bad.get("outcome")),
        message=_text(bad.get("message")),
        file=_text(bad.get("file")),
        line=int(_number(bad.get("line"))),
        events=ended.events,
    )


def runs_of(ended: tuple[Ended, ...]) -> tuple[NodeRun, ...]:
    """Convert the data about several ended runs, as `run_of` does."""
    return tuple(map(run_of, ended))


def from_json(data: Any) -> BenchResult:  # noqa: ANN401 - JSON
    """Return the result stored in a recording. Raises KeyError, TypeError or ValueError if the data is not a result."""
    return BenchResult(tuple(map(_run, data["runs"])), number(data["seconds"]))


def _run(data: dict[str, Any]) -> NodeRun:
    return NodeRun(
        node=text(data["node"]),
        exit_code=whole_or_none(data["exit_code"]),
        over=data["over"] is True,
        seconds=number(data["seconds"]),
        collected=int(number(data["collected"])),
        passed=int(number(data["passed"])),
        skipped=int(number(data["skipped"])),
        test=text(data["test"]),
        outcome=text(data["outcome"]),
        message=text(data["message"]),
        file=text(data["file"]),
        line=int(number(data["line"])),
        events=_events(data.get("events")),
    )


def _events(data: Any) -> NodeEvents | None:  # noqa: ANN401 - JSON
    if data is None:
        return None
    poses, calls, commands, all_calls = (int(number(data[key])) for key in ("poses", "calls", "commands", "all_calls"))
    first_s, clock_s = (None if data[key] is None else number(data[key]) for key in ("first_s", "clock_s"))
    return NodeEvents(poses, calls, commands, first_s, clock_s, all_calls)


def _text(value: object) -> str:
    return value[:MOST_MESSAGE] if isinstance(value, str) else ""


def _number(value: object) -> float:
    is_number = isinstance(value, int | float) and not isinstance(value, bool)
    return float(value) if is_number and 0 <= value < 1e9 else 0.0  # type: ignore[operator, arg-type]
