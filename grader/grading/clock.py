"""Choose the clock of a trial, and decide whether the trial is repeated.

The rules, in the order in which they are applied:

1. `--clock simulated` or `--clock wall` sets the clock. Rules 2 to 4 do not apply in this case.
2. Without these options, a trial starts in simulated time, in which the grader need not wait and other programs cannot
   disturb the trial. If the source contains a sign that the node may follow wall time, the trial starts in wall time
   instead (grader.trial.clues).
3. A trial in simulated time stops at the first sign that the node may be misjudged, for example: a thread calls sleep
   or waits for another process, commands arrive while the clock is stopped, the node would be too slow in wall time, or
   the node never becomes idle (grader.trial.simulated). After such a sign, the trial is repeated in wall time. If the
   node computed for long, or if several threads kept the node from becoming idle, this may have happened by chance, so
   the trial is first repeated in simulated time. There are at most SIMULATED_TRIALS such trials.
4. A trial in simulated time is also repeated in wall time if a measured value is near the edge of its tolerance, or if
   the node did not stop.
5. A trial in wall time is repeated if it fails, and if other programs or a change of the system time disturbed it.
   During the repetition, no other grader of this user grades (turns.py). A busy machine can make a correct node look
   wrong, but it cannot make a wrong node look correct, so the result of the first trial that passes counts. There are
   at most WALL_TRIALS trials. If none of them passes, the trial with the least disturbance counts.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from grader.checks.judge import in_words
from grader.checks.outcome import Status
from grader.trial.clues import wall_clues

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.checks.judge import Judgement
    from grader.checks.outcome import Outcome
    from grader.evidence.evidence import Evidence
    from grader.trial.recording import ClockName
    from grader.trial.trial import WallTimeNeeded

ClockChoice = Literal["auto", "simulated", "wall"]

SIMULATED_TRIALS = 3
"""The maximum number of trials in simulated time if each of them is stopped by chance (rule 3)."""
WALL_TRIALS = 3
"""The maximum number of trials in wall time if the trials are disturbed (rule 5)."""


@dataclass(frozen=True)
class Clock:
    """The clock of a trial. `why` is the reason for this choice, which appears in the report."""

    name: ClockName
    why: str


@dataclass(frozen=True)
class Attempt:
    """One run of a trial: the evidence with its recording, and the results of the checks."""

    evidence: Evidence
    judgement: Judgement

    @property
    def outcomes(self) -> tuple[Outcome, ...]:
        """The outcomes of the checks of this trial."""
        return self.judgement.of_trial(self.evidence.trial.id)

    @property
    def passed(self) -> bool:
        """Whether all checks of this trial passed."""
        return all(outcome.status is Status.PASSED for outcome in self.outcomes)

    @property
    def disturbance(self) -> tuple[bool, float]:
        """Whether other programs kept the machine too busy, and the total length of the stalls (s)."""
        return self.evidence.recording.crowded, self.evidence.recording.stalled_s


ALONE = Clock("simulated", "the simulator ran without a node, so its speed does not matter")
"""The clock of a trial that has no node."""


def first_clock(choice: ClockChoice, evidence: Evidence) -> Clock:
    """Return the clock with which this trial starts (rules 1 and 2)."""
    if choice != "auto":
        return Clock(choice, f"chosen with --clock {choice}")
    try:
        entry = evidence.entry_point()
        clues = wall_clues(evidence.submission.files, entry.partition(":")[0].strip() if entry else None)
    except Exception as error:  # the checks that read the source report this error
        return Clock("wall", f"the source could not be read ({in_words(error)}), so the node may use wall time")
    if clues:
        return Clock("wall", f"{clues[0].name} at {clues[0].file}:{clues[0].line} may use wall time")
    return Clock("simulated", "the source has no sign that the node uses wall time")


def stops_at_doubt(choice: ClockChoice) -> bool:
    """Return whether a trial in simulated time stops at the first sign that the node may be misjudged (rule 3)."""
    return choice == "auto"


def repeats(doubt: WallTimeNeeded, trials: int) -> bool:
    """Return whether a trial is repeated in simulated time after this doubt and so many trials (rule 3)."""
    return doubt.by_chance and trials < SIMULATED_TRIALS


def after_doubt(doubt: WallTimeNeeded) -> Clock:
    """Return the clock for repeating a trial that was stopped because the node may be misjudged (rule 3)."""
    return Clock("wall", str(doubt))


def after_simulated(choice: ClockChoice, attempt: Attempt) -> Clock | None:
    """Return the clock for repeating a trial that ran in simulated time (rule 4), or None if it is not repeated."""
    if choice == "simulated" or not any(outcome.finding.near_edge for outcome in attempt.outcomes):
        return None
    return Clock("wall", "in the trial in simulated time, a value was near its limit, or the node did not stop")


def wants_another(attempts: Sequence[Attempt]) -> bool:
    """Return whether a trial in wall time must be repeated after these attempts (rule 5)."""
    last = attempts[-1]
    return len(attempts) < WALL_TRIALS and last.disturbance > (False, 0.0) and not last.passed


def that_counts(attempts: Sequence[Attempt]) -> Attempt:
    """Return the attempt in wall time whose result counts (rule 5)."""
    return attempts[-1] if attempts[-1].passed else min(attempts, key=lambda attempt: attempt.disturbance)
