"""Read `[[trial.points]]` and `[[trial.bag]]` in exercise.toml: the inputs for a function or a program."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.common.words import shorten
from grader.exercise.call_inputs import Arc, BagInput, CallsSpec, PointsInput

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from grader.exercise.model import CheckSpec, TrialSpec
    from grader.exercise.tables import Table

ID = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
ID_WORDS = "lowercase letters, digits and single hyphens, as in half-circle"
FUNCTION = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*:[A-Za-z_]\w*")
MOST_POINTS = 10_000
MOST_M = 1000.0


def read_calls(table: Table) -> CallsSpec:
    """Return the calls of this `[[trial]]`. Mistakes are recorded in the table that contains them."""
    function = table.string("function", FUNCTION, "a function, as in my_robot_controller.circle_fit:fit_circle", "")
    calls = CallsSpec(
        function,
        tuple(_points(each) for each in table.tables("points")),
        tuple(_bag(each) for each in table.tables("bag")),
    )
    if bool(calls.points) != bool(function):
        table.problem(
            'a trial that calls a "function" needs [[trial.points]], and [[trial.points]] needs a "function".'
        )
    ids = calls.ids
    for id_ in sorted({each for each in ids if ids.count(each) > 1}):
        table.problem(f'the id "{id_}" is used more than once; each call needs its own id.')
    return calls


def unknown_calls(trials: Sequence[TrialSpec], checks: Sequence[CheckSpec]) -> Iterator[str]:
    """Yield a message for each check that refers to a call that does not exist in the check's trial."""
    calls = {trial.id: trial.calls.ids for trial in trials}
    for check in checks:
        wanted = check.params.get("call")
        known = calls.get(check.trial, ())
        if wanted is not None and wanted not in known:
            has = f"the call{'s' if len(known) > 1 else ''} {', '.join(known)}" if known else "no calls"
            yield f'[[check]] ({check.id}): "call" is "{shorten(str(wanted))}"; the trial {check.trial} has {has}.'


def _points(table: Table) -> PointsInput:
    id_ = table.string("id", ID, ID_WORDS)
    lists = table.flag("lists")
    if "radius_m" in table.values:
        points = PointsInput(id_, _arc(table), lists=lists)
    else:
        points = PointsInput(id_, None, table.numbers("x", MOST_M), table.numbers("y", MOST_M), lists)
    table.finish()
    return points


def _bag(table: Table) -> BagInput:
    id_ = table.string("id", ID, ID_WORDS)
    commands = table.whole("commands", 0, MOST_POINTS, 0)
    rate = table.number("rate_hz", 0.1, 1000.0, "from 0.1 to 1000 (Hz)")
    bag = BagInput(id_, _arc(table), rate, commands, poses=not table.flag("without_poses"))
    table.finish()
    return bag


def _arc(table: Table) -> Arc:
    within = f"from {-MOST_M:g} to {MOST_M:g} (m)"
    most_deg = 3600.0
    degrees = f"from {-most_deg:g} to {most_deg:g} (degrees)"
    return Arc(
        x_m=table.number("x_m", -MOST_M, MOST_M, within),
        y_m=table.number("y_m", -MOST_M, MOST_M, within),
        radius_m=table.number("radius_m", 1e-3, MOST_M, f"from 0.001 to {MOST_M:g} (m)"),
        from_deg=table.number("from_deg", -most_deg, most_deg, degrees, 0.0),
        to_deg=table.number("to_deg", -most_deg, most_deg, degrees, 360.0),
        count=table.whole("count", 0, MOST_POINTS),
        noise_m=table.number("noise_m", 0.0, MOST_M, f"from 0 to {MOST_M:g} (m)", 0.0),
    )
