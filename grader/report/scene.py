"""Scene: the drawing of a run on the turtle's canvas, as pure data in metres.

scene_image.py and svg.py paint the scene. The PNG, the page and the notebooks use the same scene, so they always show
the same drawing.
"""

from __future__ import annotations

import math
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.common.words import a_list, count, shorten
from grader.evidence import activity
from grader.evidence.pens import pen_spans
from grader.report.expectations import requested_path, shapes_of
from grader.report.shapes import SIDE_M, Arrow, Line, Point, Ring, Role

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.evidence.evidence import Evidence
    from grader.evidence.trajectory import Trajectory
    from grader.trial.recording import Recording

MOST_OTHERS = 40
"""The maximum number of other turtles that are drawn."""
MOST_TICKS = 150
TURNED_RAD = 0.1
"""A turtle that turned by less than this (rad) is considered not to have turned."""
TICK_M = 0.11
"""Half the length of a tick (m)."""


@dataclass(frozen=True)
class Scene:
    """The content of a drawing: the `shapes` from bottom to top, the legend's text for each role, and lines of `facts`.

    `notice` is the reason why there is no trajectory, or why the trajectory ends early. Otherwise, `notice` is empty.
    """

    shapes: tuple[Line | Ring | Arrow, ...] = ()
    legend: tuple[tuple[Role, str], ...] = ()
    facts: tuple[str, ...] = ()
    notice: str = ""


def scene_of(evidence: Evidence) -> Scene:
    """Return the scene of a run."""
    recording = evidence.run.recording
    if recording is None:
        return _without_recording(evidence)
    trajectory = evidence.trajectory
    shapes: list[Line | Ring | Arrow] = []
    legend: list[tuple[Role, str]] = []
    facts = [f"{count(len(evidence.commands), 'command')} in {activity.end_s(recording):.1f} s", *_goals(recording)]
    points = finite_points(trajectory)
    moved = trajectory.finite and len(trajectory.points[0]) > 1
    if len(points) > 1:
        shapes += _drawn(evidence, points)
        legend.append(("trajectory", "the turtle's trajectory"))
    for drawn, text in _others(recording):
        shapes += drawn
        legend.append(("other", text))
    path = requested_path(evidence)
    if path is not None:
        shapes += shapes_of(path)
        legend.append(("expected", f"required: {path.path}"))
    fitted = trajectory.circle if moved and path is not None and path.fits else None
    if fitted is not None and fitted.radius <= SIDE_M:
        shapes.append(Ring("fitted", (fitted.x, fitted.y), fitted.radius))
        legend.append(("fitted", f"best fit: radius {fitted.radius:.2f} m"))
        facts.append(f"centre ({fitted.x:.2f}, {fitted.y:.2f}) m")
        facts.append(f"RMS distance from the circle: {fitted.rms:.3f} m")
        facts.append(
            f"{abs(trajectory.turns):.2f} turns {'counter-clockwise' if trajectory.turns > 0 else 'clockwise'}"
        )
    times = [command.t_s for command in evidence.commands]
    ticks = _ticks(trajectory, times[:: len(times) // MOST_TICKS + 1]) if moved else []
    if ticks:
        shapes += ticks
        legend.append(("tick", "a command arrives"))
    cross = _cross(trajectory) if trajectory.wall.any() else []
    if cross:
        shapes += cross
        legend.append(("wall", "touches a wall"))
    shapes.append(Arrow("start", (recording.start.x, recording.start.y), recording.start.theta))
    legend.append(("start", "start"))
    notice = "" if moved else "The turtle did not move."
    if not moved and trajectory.turned_rad > TURNED_RAD:
        notice = "The turtle only turned."
    if not trajectory.finite:
        notice = "The turtle's position became NaN (not a number)."
    return Scene(tuple(shapes), tuple(legend), tuple(facts), notice)


def executables(evidence: Evidence) -> str:
    """Return the names of the programs that ran in this trial."""
    beside = evidence.exercise.beside(evidence.trial.id)
    return a_list([spec.executable for spec in (evidence.trial, *beside)])


def _without_recording(evidence: Evidence) -> Scene:
    if evidence.run.bench is not None:
        return Scene(notice="The tests do not need a turtle.")
    if evidence.run.overwhelmed is not None:
        return Scene(notice="The trial could not be finished.")
    return _bag_scene(evidence) or Scene(notice="The node was not run.")


def _bag_scene(evidence: Evidence) -> Scene | None:
    """For a step in which students record a bag, return a scene with the path of the turtle in this bag.

    Return None for other steps.
    """
    folder = next((str(spec.params["bag"]) for spec in evidence.exercise.checks if "bag" in spec.params), None)
    if folder is None:
        return None
    for topic, poses in evidence.bag(folder).poses.items():
        points = tuple(zip(poses.x, poses.y, strict=True))
        if len(points) > 1 and all(math.isfinite(each) for point in points for each in point):
            legend: tuple[tuple[Role, str], ...] = (("trajectory", f"the path in {shorten(folder)}"),)
            facts = (f"{len(points)} messages on {shorten(topic)}",)
            return Scene((Line("trajectory", points),), legend, facts)
    return Scene(notice=f"There is no path in {shorten(folder)}.")


def _goals(recording: Recording) -> list[str]:
    """Return a line such as "3 goals: 2 succeeded, 1 canceled", or an empty list if there are no goals."""
    ends = Counter(goal.status for goal in recording.goals)
    amounts = ", ".join(f"{amount} {status}" for status, amount in ends.items())
    return [f"{count(len(recording.goals), 'goal')}: {amounts}"] if amounts else []


def _drawn(evidence: Evidence, points: list[Point]) -> list[Line]:
    """Return the trajectory as lines, with a new line wherever the pen changed.

    Parts that were driven with the pen up are drawn in the same way as another turtle's path.
    """
    trajectory, spans = evidence.trajectory, pen_spans(evidence.recording)
    if len(spans) == 1 or not trajectory.finite:
        return [Line("trajectory", tuple(points))]
    lines = []
    for span in spans:
        first, last = trajectory.t_s.searchsorted([span.from_s, span.until_s]).tolist()
        part = list(zip(trajectory.x[first : last + 1].tolist(), trajectory.y[first : last + 1].tolist(), strict=True))
        moved = [point for index, point in enumerate(part) if index == 0 or point != part[index - 1]]
        if len(moved) > 1:
            lines.append(
                Line("trajectory", tuple(moved), span.pen.color) if span.pen.down else Line("other", tuple(moved))
            )
    return lines


def _others(recording: Recording) -> Iterator[tuple[list[Line | Ring | Arrow], str]]:
    """If there are turtles other than turtle1, yield their shapes and the text for the legend."""
    tracks = [track for track in recording.tracks if track.rows]
    shapes: list[Line | Ring | Arrow] = []
    for track in tracks[:MOST_OTHERS]:
        _, x, y, theta = track.rows[-1]
        if len(track.rows) > 1:
            shapes.append(Line("other", tuple((row[1], row[2]) for row in track.rows)))
        shapes.append(Arrow("other", (x, y), theta))
    if tracks:
        others = "other turtle" if len(tracks) == 1 else "other turtles"
        yield shapes, f"{others}: {a_list([shorten(track.turtle) for track in tracks], most=2)}"


def finite_points(trajectory: Trajectory) -> list[Point]:
    """Return the points of the trajectory (m) up to the first infinite or NaN value, without consecutive duplicates."""
    points: list[Point] = []
    for x, y in zip(trajectory.x.tolist(), trajectory.y.tolist(), strict=True):
        if not (math.isfinite(x) and math.isfinite(y)):
            break
        if not points or points[-1] != (x, y):
            points.append((x, y))
    return points


def _ticks(trajectory: Trajectory, times: list[float]) -> list[Line]:
    """Return a short line across the trajectory for each of these times (s) at which the turtle moves."""
    strokes: list[Line] = []
    if not len(trajectory.t_s):
        return strokes
    for index in trajectory.t_s.searchsorted(times).tolist():
        at = min(index, len(trajectory.t_s) - 1)
        x, y = float(trajectory.x[at]), float(trajectory.y[at])
        ahead = min(at + 1, len(trajectory.x) - 1)
        behind = max(ahead - 2, 0)
        dx, dy = float(trajectory.x[ahead] - trajectory.x[behind]), float(trajectory.y[ahead] - trajectory.y[behind])
        length = math.hypot(dx, dy)
        if length > 0.0:
            nx, ny = -dy / length * TICK_M, dx / length * TICK_M
            strokes.append(Line("tick", ((x - nx, y - ny), (x + nx, y + ny))))
    return strokes


def _cross(trajectory: Trajectory) -> list[Line]:
    """Return a cross where the turtle first touched a wall."""
    at = int(trajectory.wall.argmax()) + 1
    x, y = float(trajectory.x[at]), float(trajectory.y[at])
    if not (math.isfinite(x) and math.isfinite(y)):
        return []
    x, y = min(max(x, 0.2), SIDE_M - 0.2), min(max(y, 0.2), SIDE_M - 0.2)
    return [
        Line("wall", ((x - 0.15, y - 0.15), (x + 0.15, y + 0.15))),
        Line("wall", ((x - 0.15, y + 0.15), (x + 0.15, y - 0.15))),
    ]
