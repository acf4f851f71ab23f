"""The plan of a trial: its clock, start pose and inputs (based on the seed), and the topics that the checks need."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.kinds import KINDS
from grader.grading.clock import stops_at_doubt
from grader.trial.inputs import draw_inputs
from grader.trial.start_pose import start_pose, start_within
from grader.trial.trial import Plan

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.evidence.evidence import Evidence
    from grader.exercise.model import CheckSpec
    from grader.grading.clock import ClockChoice
    from grader.trial.recording import ClockName

USUAL_RADIUS_M = 2.0
"""A random start pose leaves room for a circle with this radius (m), unless a check needs a different radius."""
DEFAULT_SEED = 1
"""The seed for scenarios with random values if the user has not specified a seed."""


def plan_of(evidence: Evidence, clock: ClockName, *, choice: ClockChoice, seed: int | None) -> Plan:
    """Return the plan of this trial.

    `seed` is the seed that the user specified, and `choice` is the value of `--clock`.
    """
    scenario = evidence.trial.scenario
    ids = [evidence.trial.id, *(spec.id for spec in evidence.exercise.beside(evidence.trial.id))]
    checks = [check for check in evidence.exercise.checks if check.trial in ids]
    radii = [KINDS[check.kind].radius(evidence, check.params) for check in checks]
    radius = max((each for each in radii if each is not None), default=USUAL_RADIUS_M)
    if scenario.start_limits is not None:
        start = start_within(scenario.start_limits, DEFAULT_SEED if seed is None else seed)
    else:
        start = start_pose(DEFAULT_SEED if seed is None and scenario.anywhere else seed, radius)
    return Plan(
        clock=clock,
        start=start,
        seed=seed,
        duration_s=scenario.duration_s,
        alone=not evidence.exercise.package,
        inputs=draw_inputs(scenario, start, DEFAULT_SEED if seed is None else seed),
        stop_at_doubt=stops_at_doubt(choice),
        judged=_topics(checks),
        beside=executables_of(evidence)[1:],
    )


def executables_of(evidence: Evidence) -> tuple[str, ...]:
    """Return the executables of this trial: the executable of the trial's own node, then those of additional nodes."""
    others = evidence.exercise.beside(evidence.trial.id)
    return evidence.trial.executable, *(spec.executable for spec in others)


def _topics(checks: Sequence[CheckSpec]) -> tuple[str, ...]:
    """Return all parameter values that begin with a slash. The topics that these checks need are among them."""
    names = {value for check in checks for value in check.params.values() if isinstance(value, str)}
    return tuple(sorted(name for name in names if name.startswith("/")))
