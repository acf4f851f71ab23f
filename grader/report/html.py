"""The page on one submission: verdict, checks with the code they mean, the run to look at, the graph, the logs.

What differs from run to run (seconds, paths of recordings) is not on it, so that a page made again from a recording is
the same page.
"""

from __future__ import annotations

import math
import shlex
from dataclasses import dataclass
from typing import TYPE_CHECKING

from markupsafe import Markup

from grader.checks import seen
from grader.outcome import Status
from grader.report import charts
from grader.report.code_excerpt import excerpt
from grader.report.graph_drawing import draw_graph
from grader.report.logs import logs_of
from grader.report.page import make_page, save_page
from grader.report.plain import plain_line
from grader.report.scene import SIDE_M, scene_of
from grader.report.svg import LEFT, SIDE, TOP, scene_svg, sign
from grader.report.verdict import tone, verdict

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from grader.checks.evidence import Evidence
    from grader.outcome import Outcome, Report, Where
    from grader.report.code_excerpt import Excerpt

MOST_FRAMES = 1500
"""Of the turtle's way in the player; 20 frames a second are enough for an eye."""
MOST_ROWS = 100
"""Of the table of commands."""
CODE_BYTES = 50_000
"""Of all excerpts of code together; later checks name the place only."""
MOST_STEPS = 1000
"""Of the commands that the player tells."""


@dataclass(frozen=True)
class ShownCheck:
    """A check as the page shows it; `above` is the number of an earlier one that shows the same lines of code."""

    number: int
    outcome: Outcome
    code: Excerpt | None = None
    above: int | None = None

    @property
    def title(self) -> str:
        """Its title; nothing is said of what a hidden check looks at."""
        return "Hidden check" if self.outcome.hidden else self.outcome.title

    @property
    def seen(self) -> str:
        """What was seen; empty where that is hidden or only repeats the title."""
        text = self.outcome.finding.seen
        return "" if self.outcome.hidden or text.rstrip(".") == self.outcome.title else text

    def shows(self, where: Where) -> bool:
        """Whether the line of this place is among those shown with the check."""
        code = self.code
        return code is not None and code.file == where.file and any(line.number == where.line for line in code.lines)

    @property
    def kind(self) -> str:
        """Passed, failed, skipped, error, or advice that was not followed."""
        if self.outcome.advice and self.outcome.status is Status.FAILED:
            return "advice"
        return self.outcome.status.value


def save_html(evidence: Evidence, report: Report, file: Path) -> None:
    """Write the page. Raises UsageError where that cannot be done."""
    save_page(html_page(evidence, report), file)


def html_page(evidence: Evidence, report: Report) -> str:
    """The page as text."""
    scene = scene_of(evidence)
    recording = evidence.recording
    interval_chart = charts.intervals(evidence) if recording else None
    value_chart = charts.values(evidence) if recording else None
    graph = draw_graph(recording) if recording else None
    shown = list(_shown(evidence, report))
    fault = evidence.fault.message if evidence.fault else ""
    # One fault of the machine is told once, not with every check that it took along.
    unmade = [check for check in shown if check.kind == "error" and check.outcome.finding.seen == fault]
    values = {
        "report": report,
        "verdict": verdict(report),
        "tone": tone(report),
        "mend": [each for each in shown if each.kind in ("failed", "error", "advice") and each not in unmade],
        "unmade": unmade,
        "skipped": [check for check in shown if check.kind == "skipped"],
        "passed": [check for check in shown if check.kind == "passed"],
        "recording": recording,
        "canvas": Markup(scene_svg(scene, turtle=True)),
        "legend": [(Markup(sign(role)), text) for role, text in scene.legend],
        "facts": scene.facts,
        "intervals": interval_chart,
        "values": value_chart,
        "interval_svg": Markup(interval_chart.svg) if interval_chart else "",
        "value_svg": Markup(value_chart.svg) if value_chart else "",
        "rows": _rows(evidence),
        "most_rows": MOST_ROWS,
        "amount": len(evidence.commands) if recording else 0,
        "end": _end(evidence),
        "graph": graph,
        "graph_svg": Markup(graph.svg) if graph else "",
        "logs": logs_of(evidence),
        "again": _again(report),
        "fault": fault,
    }
    return make_page("report.html", "report.js", _run(evidence), values)


def _shown(evidence: Evidence, report: Report) -> Iterator[ShownCheck]:
    """Every check; lines of code are shown once."""
    shown: list[ShownCheck] = []
    room = CODE_BYTES
    for number, outcome in enumerate(report.outcomes, 1):
        where = None if outcome.hidden or outcome.status is not Status.FAILED else outcome.finding.where
        above = None if where is None else next((each.number for each in shown if each.shows(where)), None)
        code = None if above else excerpt(evidence, where)
        room -= code.size if code else 0
        if room < 0:
            code = None
        shown.append(ShownCheck(number, outcome, code, above))
        yield shown[-1]


def _end(evidence: Evidence) -> str:
    """How the node's process ended, in a sentence."""
    recording = evidence.recording
    if recording is None:
        return ""
    end = recording.end
    # A shell tells the end by a signal as 128 and the signal's number.
    code = end.exit_code if end.exit_code >= 0 else 128 - end.exit_code
    if end.by == "itself":
        return f"The node ended by itself after {end.t_s:.1f} s, with exit code {code}."
    told = {"SIGINT": "on Ctrl-C", "SIGTERM": "only on SIGTERM", "SIGKILL": "only when it was killed (SIGKILL)"}[end.by]
    return f"The node stopped {told}, with exit code {code}."


def _again(report: Report) -> str:
    """The command that grades the submission again."""
    command = ["grader", "check", report.submission, "--exercise", report.exercise]
    if report.seed is not None:
        command += ["--seed", str(report.seed)]
    return plain_line(shlex.join(command))


def _rows(evidence: Evidence) -> list[tuple[str, ...]]:
    """Each command in words: when, how long after the one before, linear.x, angular.z."""
    if evidence.recording is None:
        return []
    rows: list[tuple[str, ...]] = []
    before: float | None = None
    for command in evidence.commands[:MOST_ROWS]:
        since = "" if before is None else f"{command.t_s - before:.3f}"
        rows.append((f"{command.t_s:.3f}", since, f"{command.linear[0]:g}", f"{command.angular[2]:g}"))
        before = command.t_s
    return rows


def _run(evidence: Evidence) -> dict[str, object]:
    """What the player needs: the turtle (m, rad) at times (s), the commands; null for what is no finite number."""
    recording = evidence.recording
    if recording is None:
        return {}
    end_s = seen.end_s(recording)
    frames = recording.frames
    count = int((frames.t_s <= end_s).sum())
    every = count // MOST_FRAMES + 1
    start = recording.start
    commands = evidence.commands[:MOST_STEPS]
    return {
        "end": round(end_s, 3),
        "canvas": {"left": LEFT, "bottom": TOP + SIDE, "scale": SIDE / SIDE_M},
        "across": charts.WIDTH - charts.LEFT - charts.RIGHT,
        "t": [0, *_numbers(frames.t_s[:count:every].tolist())],
        "x": [round(start.x, 3), *_numbers(frames.x[:count:every].tolist())],
        "y": [round(start.y, 3), *_numbers(frames.y[:count:every].tolist())],
        "theta": [round(start.theta, 3), *_numbers(frames.theta[:count:every].tolist())],
        "commands": [
            [round(command.t_s, 3), _number(command.linear[0]), _number(command.angular[2])] for command in commands
        ],
    }


def _numbers(values: list[float]) -> list[float | None]:
    return [_number(value) for value in values]


def _number(value: float) -> float | None:
    return round(value, 3) if math.isfinite(value) else None
