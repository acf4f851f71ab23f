"""Judge a submission: every check of the exercise, each after those that it needs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.kinds import KINDS
from grader.checks.outcome import Finding, Outcome, Status, failed
from grader.common.words import shorten
from grader.errors import MachineError, TooLargeError
from grader.evidence.stage import STAGES

if TYPE_CHECKING:
    from collections.abc import Iterable

    from grader.evidence.evidence import Evidence
    from grader.exercise.model import CheckSpec


def judge(evidence: Evidence) -> tuple[Outcome, ...]:
    """The outcome of every check, in the order of the exercise.

    A check is skipped when one that it needs did not pass, and names the first cause. A check that needs what the
    machine could not make (`evidence.fault`) is an `error`, and so is what needs that one.
    """
    specs = {spec.id: spec for spec in evidence.exercise.checks}
    findings: dict[str, Finding] = {}
    causes: dict[str, CheckSpec] = {}
    for spec in _in_order(specs.values()):
        cause = next((causes[need] for need in spec.needs if need in causes), None)
        finding = (
            _judge_one(evidence.from_trial(spec.trial), spec) if cause is None else _because(cause, findings[cause.id])
        )
        findings[spec.id] = finding
        if finding.status is not Status.PASSED and not KINDS[spec.kind].advice:
            causes[spec.id] = cause or spec
    return tuple(_outcome(spec, findings[spec.id]) for spec in evidence.exercise.checks)


@dataclass(frozen=True)
class Early:
    """What is certain before anything of a submission has run: outcomes that failed, ids that cannot pass any more."""

    failed: tuple[Outcome, ...]
    blocked: frozenset[str]

    def may_run(self, evidence: Evidence) -> bool:
        """Whether the trial may still be wanted: some check of it is not blocked."""
        specs = evidence.exercise.checks
        return any(_of_this_trial(evidence, spec) and spec.id not in self.blocked for spec in specs)


def judge_early(evidence: Evidence) -> Early:
    """Judge what the files alone tell: nothing is built, no process starts."""
    failed_: list[Outcome] = []
    blocked: set[str] = set()
    for spec in _in_order(evidence.exercise.checks):
        kind = KINDS[spec.kind]
        if any(need in blocked for need in spec.needs):
            blocked.add(spec.id)
            continue
        try:
            finding = kind.judge_early(evidence.from_trial(spec.trial), spec.params)
        except Exception:  # (it is judged once more in the end, and told then)
            continue
        if finding is not None and finding.status is Status.FAILED and not kind.advice:
            blocked.add(spec.id)
            failed_.append(_outcome(spec, finding))
    return Early(tuple(failed_), frozenset(blocked))


def wants_trial(evidence: Evidence) -> bool:
    """True when some check of this trial would be judged if there were a recording: else it needs not run."""
    outcomes = {outcome.id: outcome for outcome in judge(evidence)}
    return any(
        _of_this_trial(evidence, spec) and not any(_blocked(outcomes[need]) for need in spec.needs)
        for spec in evidence.exercise.checks
    )


def near_edge(outcomes: Iterable[Outcome]) -> bool:
    """True when some measured value is so near a tolerance's edge that simulated time must not decide."""
    return any(outcome.finding.near_edge for outcome in outcomes)


def of_this_trial(evidence: Evidence) -> tuple[Outcome, ...]:
    """The outcomes of the checks that judge this trial's recording."""
    specs = evidence.exercise.checks
    return tuple(
        outcome for spec, outcome in zip(specs, judge(evidence), strict=True) if _of_this_trial(evidence, spec)
    )


def _of_this_trial(evidence: Evidence, spec: CheckSpec) -> bool:
    return KINDS[spec.kind].stage == "trial" and spec.trial == evidence.trial.id


def _blocked(outcome: Outcome) -> bool:
    return outcome.status in (Status.FAILED, Status.SKIPPED)


def _in_order(specs: Iterable[CheckSpec]) -> list[CheckSpec]:
    """Each check after all that it needs, else in the order of the exercise (which was read without circles)."""
    waiting = list(specs)
    done: dict[str, CheckSpec] = {}
    while waiting:
        ready = [spec for spec in waiting if all(need in done for need in spec.needs)]
        done |= {spec.id: spec for spec in ready}
        waiting = [spec for spec in waiting if spec.id not in done]
    return list(done.values())


def _judge_one(evidence: Evidence, spec: CheckSpec) -> Finding:
    kind = KINDS[spec.kind]
    made = {"source": True, "build": evidence.build is not None, "trial": evidence.run.recording is not None}
    fault = evidence.fault
    if fault is not None and STAGES.index(kind.stage) >= STAGES.index(fault.stage) and not made[kind.stage]:
        return unreadable(fault.message) if fault.unreadable else Finding(Status.ERROR, fault.message)
    if kind.stage == "trial" and evidence.run.overwhelmed is not None:
        return _overwhelmed(evidence.run.overwhelmed)
    if not made[kind.stage]:
        return Finding(Status.SKIPPED, "Not judged, since the node was not run.")
    try:
        return kind.judge(evidence, spec.params)
    except MachineError as error:
        return Finding(Status.ERROR, str(error))
    except Exception as error:  # (one broken check must not take a class's other outcomes with it)
        return unreadable(in_words(error))


def unreadable(how: str) -> Finding:
    """A failed finding on what the grader could not read: nobody may choose that the grader breaks.

    A check sees nothing but what a submission has made, so whatever breaks it comes from there.
    """
    seen = f"The submission could not be read: {shorten(how, 150)}."
    expected = "The grader can read what is handed in, and what it does."
    cause = "Very large, very deep or damaged content does this. If yours is none of that, please report it."
    return failed("unreadable", seen, expected, cause)


def in_words(error: Exception) -> str:
    """An exception on one line; of ours, the text alone."""
    if isinstance(error, TooLargeError):
        return str(error).rstrip(".")
    return f"{type(error).__name__}: {error}".rstrip(" :.")


def _overwhelmed(how: str) -> Finding:
    seen = f"The trial could not be finished: the node brought the simulator down ({shorten(how, 150)})."
    expected = "The simulator goes on whatever is published or called at a sensible rate."
    cause = "It sends without end, or what no simulator can read. If yours does neither, please report this."
    return failed("overwhelmed", seen, expected, cause)


def _because(cause: CheckSpec, finding: Finding) -> Finding:
    if finding.status is Status.ERROR:
        return finding
    named = "a hidden check" if cause.hidden else f'"{cause.title}"'
    return Finding(Status.SKIPPED, f"Not judged, since {named} did not pass.")


def _outcome(spec: CheckSpec, finding: Finding) -> Outcome:
    points = spec.points if finding.status is Status.PASSED else 0.0
    advice = KINDS[spec.kind].advice
    return Outcome(spec.id, spec.kind, spec.title, points, spec.points, finding, spec.hidden, advice)
