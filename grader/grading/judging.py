"""Judging one submission while it is graded: its files first, then what was built, then each trial.

All of it reads what a student wrote, so it happens in the reader's process. What that process may not finish is the
submission's own failure: from then on every check of it is `unreadable`, and nothing of it is read any more.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.judge import Early, in_words, judge, judge_early
from grader.errors import UnreadableError
from grader.evidence.evidence import Fault
from grader.submission.reader import read
from grader.trial.clues import wall_clues

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.checks.outcome import Outcome
    from grader.evidence.evidence import Evidence
    from grader.trial.recording import ClockName

    Clocks = Mapping[str, tuple[ClockName, str]]


@dataclass
class Judging:
    """What is known of one submission so far; the same evidence is judged once."""

    fault: Fault | None = None
    """That it could not be read."""
    _judged: Evidence | None = None
    _outcomes: tuple[Outcome, ...] = ()
    _clocks: Clocks = dataclasses.field(default_factory=dict)
    """The clock that each trial begins under, by its id, and why."""

    def early(self, evidence: Evidence) -> Early:
        """What is certain from the files alone."""
        try:
            early, self._clocks = read(_early, evidence)
        except UnreadableError as error:
            self.fault = Fault("source", in_words(error), unreadable=True)
            return Early((), frozenset(spec.id for spec in evidence.exercise.checks))
        return early

    def outcomes(self, evidence: Evidence) -> tuple[Outcome, ...]:
        """The outcome of every check by this evidence."""
        self._judge(evidence)
        return self._outcomes

    def first_clock(self, evidence: Evidence) -> tuple[ClockName, str]:
        """The clock under which the trial begins that the evidence is looked at from, and why."""
        if evidence.build is not None:
            self._judge(evidence)
        return self._clocks.get(evidence.trial.id, ("wall", "the source could not be read"))

    def known(self, evidence: Evidence) -> Evidence:
        """The evidence, with the fault that it could not be read."""
        return evidence if self.fault is None else dataclasses.replace(evidence, fault=self.fault)

    def _judge(self, evidence: Evidence) -> None:
        if self._judged is not None and _same(evidence, self._judged):
            return
        if self.fault is None:
            try:
                self._outcomes, self._clocks = read(_all, evidence)
            except UnreadableError as error:
                self.fault = Fault("source", in_words(error), unreadable=True)
        if self.fault is not None:
            self._outcomes = judge(self.known(evidence))
        self._judged = evidence


def _same(one: Evidence, other: Evidence) -> bool:
    """Whether they say the same, from whichever trial they are looked at."""
    return one.build is other.build and one.runs is other.runs and one.fault is other.fault


def _early(evidence: Evidence) -> tuple[Early, Clocks]:
    return judge_early(evidence), _first_clocks(evidence)


def _all(evidence: Evidence) -> tuple[tuple[Outcome, ...], Clocks]:
    return judge(evidence), _first_clocks(evidence)


def _first_clocks(evidence: Evidence) -> Clocks:
    if not evidence.exercise.package:
        return {}
    views = (evidence.from_trial(spec.id) for spec in evidence.exercise.trials)
    return {seen.trial.id: _first_clock(seen) for seen in views}


def _first_clock(evidence: Evidence) -> tuple[ClockName, str]:
    try:
        entry = evidence.entry_point()
        clues = wall_clues(evidence.submission.files, entry.partition(":")[0].strip() if entry else None)
    except Exception as error:  # told by the checks that read the source, too
        return "wall", f"the source could not be read ({in_words(error)}), so it may follow the wall's clock"
    if clues:
        first = clues[0]
        return "wall", f"{first.name} at {first.file}:{first.line} may follow the wall's clock"
    return "simulated", "the node waits only for ROS time and messages, so its seconds need not be waited for"
