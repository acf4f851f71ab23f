"""Judge a submission: run every check of the exercise, each check after the checks that it needs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.hidden_error import with_hidden_error
from grader.checks.causes.why_rate import WITHOUT_PAUSE, period_of_zero
from grader.checks.kinds import KINDS
from grader.checks.outcome import Finding, Outcome, Status, failed
from grader.checks.starved import unless_too_busy
from grader.common.words import shorten
from grader.errors import MachineError, UnreadableError
from grader.evidence.stage import STAGES

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from grader.evidence.evidence import Evidence
    from grader.evidence.stage import Stage
    from grader.exercise.model import CheckSpec, Exercise


@dataclass(frozen=True)
class Judgement:
    """The findings of all checks, based on the evidence that exists so far.

    `findings` contains a finding for every check. The findings in `settled` are final: further evidence cannot change
    them. Any other finding may change when more evidence exists.
    """

    exercise: Exercise
    findings: Mapping[str, Finding]
    settled: Mapping[str, Finding]

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """The outcome of every check, in the order of the exercise."""
        return tuple(_outcome(spec, self.findings[spec.id]) for spec in self.exercise.checks)

    def of_trial(self, trial: str) -> tuple[Outcome, ...]:
        """Return the outcomes of all checks that use the recording of the trial with this id."""
        return tuple(
            _outcome(spec, self.findings[spec.id])
            for spec in self.exercise.checks
            if _judges_trial(self.exercise, spec, trial)
        )

    def wants(self, trial: str) -> bool:
        """Return whether any check would use a recording of the trial with this id.

        The trial need not run if no check would use its recording.
        """
        return any(
            _judges_trial(self.exercise, spec, trial) and not any(_blocks(self.findings[need]) for need in spec.needs)
            for spec in self.exercise.checks
        )


def judge(evidence: Evidence) -> tuple[Outcome, ...]:
    """Return the outcome of every check, in the order of the exercise.

    A check is skipped if it needs a check that did not pass. Advice never blocks another check. The message of the
    skipped check contains the title of the first check that did not pass, unless that check is hidden. If the machine
    could not produce the evidence for a check (`evidence.fault`), the status of that check and of every check that
    needs it is `error`. If the evidence cannot be read because of the submission, the check fails.
    """
    return judge_so_far(evidence, {}).outcomes


def judge_so_far(evidence: Evidence, settled: Mapping[str, Finding]) -> Judgement:
    """Judge the evidence of the stages that are complete.

    Checks that already have a finding in `settled` are not run again.
    """
    findings: dict[str, Finding] = {}
    causes: dict[str, CheckSpec] = {}
    stands = dict(settled)
    for spec in _in_order(evidence.exercise.checks):
        cause = next((causes[need] for need in spec.needs if need in causes), None)
        view = evidence.from_trial(spec.trial)
        if spec.id in settled:
            finding = settled[spec.id]
        elif cause is not None:
            finding = _because(cause, findings[cause.id])
        else:
            finding = _judge_one(view, spec)
        findings[spec.id] = finding
        final = cause.id in stands if cause is not None else _is_complete(view, spec)
        if final and finding.status is not Status.ERROR:
            stands[spec.id] = finding
        if finding.status is not Status.PASSED and not KINDS[spec.kind].advice:
            causes[spec.id] = cause or spec
    return Judgement(evidence.exercise, findings, stands)


@dataclass(frozen=True)
class Early:
    """The results that are certain before any code runs: failed outcomes, and ids of checks that cannot pass."""

    failed: tuple[Outcome, ...]
    blocked: frozenset[str]

    def may_run(self, evidence: Evidence) -> bool:
        """Return whether the trial may be needed: at least one of the checks that use its recording is not blocked."""
        exercise, trial = evidence.exercise, evidence.trial.id
        return any(_judges_trial(exercise, spec, trial) and spec.id not in self.blocked for spec in exercise.checks)


def judge_early(evidence: Evidence) -> Early:
    """Judge only the files, without building anything or starting a process."""
    failed_: list[Outcome] = []
    blocked: set[str] = set()
    for spec in _in_order(evidence.exercise.checks):
        kind = KINDS[spec.kind]
        if any(need in blocked for need in spec.needs):
            blocked.add(spec.id)
            continue
        try:
            finding = kind.judge_early(evidence.from_trial(spec.trial), spec.params)
        except Exception:  # the check runs again later and reports the error then
            continue
        if finding is not None and finding.status is Status.FAILED and not kind.advice:
            blocked.add(spec.id)
            failed_.append(_outcome(spec, finding))
    return Early(tuple(failed_), frozenset(blocked))


def _judges_trial(exercise: Exercise, spec: CheckSpec, trial: str) -> bool:
    """Return whether the check uses the recording of this trial.

    A check uses the recording of its own trial. If this trial has a value for `beside`, the check also uses the trial
    with that id. The second trial of the kind `places_differ` does not count, because other checks use it.
    """
    return KINDS[spec.kind].stage == "trial" and trial in (spec.trial, exercise.trial(spec.trial).beside)


def _blocks(finding: Finding) -> bool:
    return finding.status in (Status.FAILED, Status.SKIPPED)


def _in_order(specs: Iterable[CheckSpec]) -> list[CheckSpec]:
    """Sort the checks so that each check comes after all the checks that it needs. Dependencies are never circular."""
    waiting = list(specs)
    done: dict[str, CheckSpec] = {}
    while waiting:
        ready = [spec for spec in waiting if all(need in done for need in spec.needs)]
        done |= {spec.id: spec for spec in ready}
        waiting = [spec for spec in waiting if spec.id not in done]
    return list(done.values())


def _is_made(evidence: Evidence, stage: Stage) -> bool:
    """Return whether the evidence of this stage exists."""
    return {"source": True, "build": evidence.build is not None, "trial": evidence.run.made}[stage]


def _is_complete(evidence: Evidence, spec: CheckSpec) -> bool:
    """Return whether all evidence for this check exists, or can no longer be collected."""
    stage = KINDS[spec.kind].stage
    return _is_made(evidence, stage) or (stage == "trial" and evidence.run.overwhelmed is not None)


def _judge_one(evidence: Evidence, spec: CheckSpec) -> Finding:
    kind = KINDS[spec.kind]
    made = _is_made(evidence, kind.stage)
    fault = evidence.fault
    if fault is not None and fault.stage == "source":
        return unreadable(fault.message)
    if fault is not None and STAGES.index(kind.stage) >= STAGES.index(fault.stage) and not made:
        return unreadable(fault.message) if fault.unreadable else Finding(Status.ERROR, fault.message)
    if kind.stage == "trial" and evidence.run.overwhelmed is not None:
        return _overwhelmed(evidence, evidence.run.overwhelmed)
    if not made:
        missing = "the package was not built" if kind.stage == "build" else "its trial was not run"
        return Finding(Status.SKIPPED, f"Not judged, because {missing}.")
    try:
        finding = kind.judge(evidence, spec.params)
        if finding.status is not Status.FAILED or kind.stage != "trial" or evidence.run.recording is None:
            return finding
        of_files = kind.judge_early(evidence, spec.params) is not None
        return finding if of_files else unless_too_busy(with_hidden_error(finding, evidence), evidence.recording)
    except MachineError as error:
        return Finding(Status.ERROR, str(error))
    except Exception as error:  # an exception in one check must not discard the other outcomes of a whole class
        return unreadable(in_words(error))


def unreadable(how: str) -> Finding:
    """Return a failed finding about a submission that the grader cannot read.

    The status of this finding is not `error`: a check reads only data from the submission, so the submission is
    considered the cause of an exception in the check.
    """
    observed = f"The submission could not be read: {shorten(how, 150)}."
    expected = "The grader can read the submitted files and the data that the node sends."
    cause = (
        "Very large, deeply nested or damaged content can cause this. If your submission "
        "contains nothing of this kind, please report this as a bug in the grader."
    )
    return failed(observed, expected, Cause("unreadable", cause))


def in_words(error: Exception) -> str:
    """Return the type and text of the exception, or only the text of an UnreadableError, without a full stop."""
    if isinstance(error, UnreadableError):
        return str(error).rstrip(".")
    return f"{type(error).__name__}: {error}".rstrip(" :.")


def _overwhelmed(evidence: Evidence, how: str) -> Finding:
    observed = f"The trial could not be finished: the node made the simulator fail ({shorten(how, 150)})."
    expected = "The simulator keeps running while the node publishes and calls services at a reasonable rate."
    cause = (
        "The node sends without a pause, or sends invalid data. If your node pauses and sends valid data, "
        "please report this as a bug in the grader."
    )
    timer = period_of_zero(evidence, "publish")
    if timer is not None:
        return failed(observed, expected, Cause("overwhelmed", WITHOUT_PAUSE, timer.where))
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
