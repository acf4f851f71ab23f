"""The content of a page for each trial: the canvas with its player, the charts, the graph and the tables."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from markupsafe import Markup

from grader.common.words import a_list, count
from grader.evidence import activity
from grader.report import charts
from grader.report.calls_and_goals import call_rows, goal_rows, moments
from grader.report.expectations import must_drive
from grader.report.graph_drawing import GraphDrawing, draw_graph
from grader.report.scene import executables, scene_of
from grader.report.shapes import SIDE_M
from grader.report.svg import LEFT, SIDE, TOP, scene_svg, sign

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.evidence.evidence import Evidence
    from grader.trial.recording import Recording

MOST_FRAMES = 1500
"""The approximate maximum number of trajectory points in all players of a page together."""
MOST_ROWS = 100
"""The maximum number of rows in the table of commands."""
MOST_STEPS = 1000
"""The maximum number of commands in all players of a page together."""


@dataclass(frozen=True)
class Picture:
    """A chart in the form that the page's template needs."""

    svg: Markup
    caption: str


@dataclass(frozen=True)
class Run:
    """A trial in the form that the page's template needs.

    `data` is the input of the player. `end` describes how the node's process exited. `idle` is true if a check of
    this trial requires commands but no command arrived. `amount`, `all_calls` and `all_goals` count all commands, calls
    and goals. The tables show only the first of them.
    """

    key: str
    title: str
    duration_s: float
    canvas: Markup
    legend: tuple[tuple[Markup, str], ...]
    facts: tuple[str, ...]
    end: str
    charts: tuple[Picture, ...]
    rows: tuple[tuple[str, ...], ...]
    amount: int
    idle: bool
    calls: tuple[tuple[str, ...], ...]
    all_calls: int
    goals: tuple[tuple[str, ...], ...]
    all_goals: int
    graph: GraphDrawing | None
    graph_svg: Markup
    graph_narrow: Markup
    data: dict[str, object]


def runs_of(evidences: Sequence[Evidence], key: str = "run") -> list[Run]:
    """Return the trials with a recording, in order. If there are several trials, each trial has a title.

    A trial whose node runs in another trial (`beside`) is left out. Every id contains `key`.
    """
    several = len(evidences) > 1
    drawn = [evidence for evidence in evidences if not evidence.trial.beside]
    tried = [(number, evidence) for number, evidence in enumerate(drawn) if evidence.run.recording is not None]
    return [_run(evidence, f"{key}-{number}" if number else key, several, len(tried)) for number, evidence in tried]


def _run(evidence: Evidence, key: str, several: bool, among: int) -> Run:
    scene = scene_of(evidence)
    bins = max(charts.BINS // among, 20)
    found = (
        charts.intervals(evidence, f"{key}-intervals", bins),
        charts.values(evidence, f"{key}-values", bins),
    )
    recording = evidence.recording
    graph = draw_graph(recording, f"{key}-graph")
    return Run(
        key=key,
        title=executables(evidence) if several else "",
        duration_s=recording.duration_s,
        canvas=Markup(scene_svg(scene, turtle=True, name=f"{key}-canvas")),
        legend=tuple((Markup(sign(role)), text) for role, text in scene.legend),
        facts=(*scene.facts, *_left_out(recording)),
        end=_end(evidence),
        charts=tuple(Picture(Markup(each.svg), each.caption) for each in found if each is not None),
        rows=tuple(_rows(evidence)),
        amount=len(evidence.commands),
        calls=tuple(call_rows(recording)),
        all_calls=len(recording.calls),
        goals=tuple(goal_rows(recording)),
        all_goals=len(recording.goals),
        idle=must_drive(evidence) and not evidence.commands,
        graph=graph,
        graph_svg=Markup(graph.svg if graph else ""),
        graph_narrow=Markup(graph.narrow if graph else ""),
        data=_data(evidence, among),
    )


def _left_out(recording: Recording) -> list[str]:
    """Describe the data that was left out because the recording was full."""
    amounts = (
        (recording.dropped, "message", ""),
        (recording.interventions_dropped, "call", " to the simulator's services and actions"),
        (recording.graph_dropped, "part", " of the graph"),
    )
    left_out = [count(amount, thing) + of for amount, thing, of in amounts if amount]
    return [f"The recording was full. It does not contain {a_list(left_out)}."] if left_out else []


def _end(evidence: Evidence) -> str:
    """Describe in one sentence how the node's process exited."""
    if not evidence.trial.executable:
        return "The simulator ran without a node."
    end = evidence.recording.end
    # If a signal terminated the process, a shell reports 128 plus the signal's number as the exit code.
    code = end.exit_code if end.exit_code >= 0 else 128 - end.exit_code
    if end.out_of is not None:
        when = f" after {end.t_s:.1f} s" if end.by == "itself" else ""
        return f"The node was killed{when}, because it used all the {end.out_of} that a node may use."
    if end.by == "itself":
        return f"The node exited on its own after {end.t_s:.1f} s, with exit code {code}."
    when = {"SIGINT": "on Ctrl-C", "SIGTERM": "only on SIGTERM", "SIGKILL": "only when it was killed (SIGKILL)"}[end.by]
    return f"The node stopped {when}, with exit code {code}."


def _rows(evidence: Evidence) -> list[tuple[str, ...]]:
    """Return the first commands as strings: time, time since the previous command, linear.x, angular.z."""
    rows: list[tuple[str, ...]] = []
    before: float | None = None
    for command in evidence.commands[:MOST_ROWS]:
        since = "" if before is None else f"{command.t_s - before:.3f}"
        rows.append((f"{command.t_s:.3f}", since, f"{command.linear[0]:g}", f"{command.angular[2]:g}"))
        before = command.t_s
    return rows


def _data(evidence: Evidence, among: int) -> dict[str, object]:
    """Return the data for the player: poses (m, rad) by time (s), commands, calls and goals.

    A value that is not finite becomes None.
    """
    recording = evidence.recording
    end_s = activity.end_s(recording)
    frames = recording.frames
    count = int((frames.t_s <= end_s).sum())
    every = count * among // MOST_FRAMES + 1
    start = recording.start
    commands = evidence.commands[: MOST_STEPS // among]
    return {
        "end": round(end_s, 3),
        "canvas": {"left": LEFT, "bottom": TOP + SIDE, "scale": SIDE / SIDE_M},
        "across": charts.WIDTH - charts.LEFT - charts.RIGHT,
        "t": [0, *_numbers(frames.t_s[:count:every].tolist())],
        "x": [round(start.x, 3), *_numbers(frames.x[:count:every].tolist())],
        "y": [round(start.y, 3), *_numbers(frames.y[:count:every].tolist())],
        "theta": [round(start.theta, 3), *_numbers(frames.theta[:count:every].tolist())],
        "calls": [[round(t_s, 3), text] for t_s, text in moments(recording)],
        "commands": [
            [round(command.t_s, 3), _number(command.linear[0]), _number(command.angular[2])] for command in commands
        ],
    }


def _numbers(values: list[float]) -> list[float | None]:
    return [_number(value) for value in values]


def _number(value: float) -> float | None:
    return round(value, 3) if math.isfinite(value) else None
