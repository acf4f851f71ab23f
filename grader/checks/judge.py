"""Judge a submission: run every check of the exercise, each after the checks that it needs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.causes.cause import Cause
from grader.checks.kinds import KINDS
from grader.checks.outcome import Finding, Outcome, Status, failed
from grader.common.words import shorten
from grader.errors import MachineError, UnreadableError
from grader.evidence.stage import STAGES

if TYPE_CHECKING:
    from collections.abc import Iterable

    from grader.evidence.evidence import Evidence
    from grader.exercise.model import CheckSpec


def judge(evidence: Evidence) -> tuple[Outcome, ...]:
    """Return the outcome of every check, in the order of the exercise.

    A check is skipped when a check that it needs did not pass; its message names the first such check. A check whose
    evidence the machine could not produce (`evidence.fault`) is an `error`, and so is every check that needs it.
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
    """What is certain before any code of the submission runs: failed outcomes, and ids of checks that cannot pass."""

    failed: tuple[Outcome, ...]
    blocked: frozenset[str]

    def may_run(self, evidence: Evidence) -> bool:
        """Return whether the trial may still be needed: at least one of its checks is not blocked."""
        specs = evidence.exercise.checks
        return any(_of_this_trial(evidence, spec) and spec.id not in self.blocked for spec in specs)


def judge_early(evidence: Evidence) -> Early:
    """Judge the files alone: nothing is built and no process starts."""
    failed_: list[Outcome] = []
    blocked: set[str] = set()
    for spec in _in_order(evidence.exercise.checks):
        kind = KINDS[spec.kind]
        if any(need in blocked for need in spec.needs):
            blocked.add(spec.id)
            continue
        try:
            finding = kind.judge_early(evidence.from_trial(spec.trial), spec.params)
        except Exception:  # (the check runs again at the end and reports the error then)
            continue
        if finding is not None and finding.status is Status.FAILED and not kind.advice:
            blocked.add(spec.id)
            failed_.append(_outcome(spec, finding))
    return Early(tuple(failed_), frozenset(blocked))


def wants_trial(evidence: Evidence, outcomes: Iterable[Outcome]) -> bool:
    """Return whether any check of this trial would use a recording. If not, the trial does not have to run."""
    by_id = {outcome.id: outcome for outcome in outcomes}
    return any(
        _of_this_trial(evidence, spec) and not any(_blocked(by_id[need]) for need in spec.needs)
        for spec in evidence.exercise.checks
    )


def near_edge(outcomes: Iterable[Outcome]) -> bool:
    """Return whether a measured value is so close to the edge of its tolerance that simulated time must not decide."""
    return any(outcome.finding.near_edge for outcome in outcomes)


def of_this_trial(evidence: Evidence, outcomes: Iterable[Outcome]) -> tuple[Outcome, ...]:
    """Return those of all outcomes that judge the recording of this trial."""
    specs = evidence.exercise.checks
    return tuple(outcome for spec, outcome in zip(specs, outcomes, strict=True) if _of_this_trial(evidence, spec))


def _of_this_trial(evidence: Evidence, spec: CheckSpec) -> bool:
    return KINDS[spec.kind].stage == "trial" and spec.trial == evidence.trial.id


def _blocked(outcome: Outcome) -> bool:
    return outcome.status in (Status.FAILED, Status.SKIPPED)


def _in_order(specs: Iterable[CheckSpec]) -> list[CheckSpec]:
    """Sort the checks so that each comes after all that it needs (the exercise was read without cycles)."""
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
    if fault is not None and fault.stage == "source":
        return unreadable(fault.message)
    if fault is not None and STAGES.index(kind.stage) >= STAGES.index(fault.stage) and not made[kind.stage]:
        return unreadable(fault.message) if fault.unreadable else Finding(Status.ERROR, fault.message)
    if kind.stage == "trial" and evidence.run.overwhelmed is not None:
        return _overwhelmed(evidence.run.overwhelmed)
    if not made[kind.stage]:
        return Finding(Status.SKIPPED, "Not judged, because the node was not run.")
    try:
        return kind.judge(evidence, spec.params)
    except MachineError as error:
        return Finding(Status.ERROR, str(error))
    except Exception as error:  # (one failing check must not lose the other outcomes of a class)
        return unreadable(in_words(error))


def unreadable(how: str) -> Finding:
    """Return a failed finding about a submission that the grader cannot read.

    It is not an error: a check reads only what the submission produced, so only the submission can make it fail.
    """
    observed = f"The submission could not be read: {shorten(how, 150)}."
    expected = "The grader can read the submitted files and the data that the node sends."
    cause = "Very large, deeply nested or damaged content can cause this. If yours is none of that, please report it."
    return failed(observed, expected, Cause("unreadable", cause))


def in_words(error: Exception) -> str:
    """Return the exception on one line; of ours, the text alone."""
    if isinstance(error, UnreadableError):
        return str(error).rstrip(".")
    return f"{type(error).__name__}: {error}".rstrip(" :.")


def _overwhelmed(how: str) -> Finding:
    observed = f"The trial could not be finished: the node made the simulator fail ({shorten(how, 150)})."
    expected = "The simulator keeps running while the node publishes and calls services at a reasonable rate."
    cause = "The node sends without a pause, or sends invalid data. If yours does neither, please report this."
    return failed(observed, expected, Cause("overwhelmed", cause))


def _because(cause: CheckSpec, finding: Finding) -> Finding:
    if finding.status is Status.ERROR:
        return finding
    named = "a hidden check" if cause.hidden else f'"{cause.title}"'
    return Finding(Status.SKIPPED, f"Not judged, because {named} did not pass.")


def _outcome(spec: CheckSpec, finding: Finding) -> Outcome:
    points = spec.points if finding.status is Status.PASSED else 0.0
    advice = KINDS[spec.kind].advice
    return Outcome(spec.id, spec.kind, spec.title, points, spec.points, finding, spec.hidden, advice)
