"""Judging: check the files of a submission, then its build, then its trials, as soon as each of them is available.

Judging reads files that a student wrote, so it runs in a child process (submission/reader.py). If the child process
exceeds its limits, the submission is considered the cause, and nothing more is read: each check fails with the
diagnosis `unreadable`, or is skipped because it needs such a check.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from grader.checks.judge import Early, Judgement, in_words, judge_early, judge_so_far
from grader.common.lazy import load_catkin_pkg
from grader.errors import UnreadableError
from grader.evidence.evidence import Fault
from grader.grading.clock import Clock, ClockChoice, first_clock
from grader.submission.reader import read

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.checks.outcome import Finding
    from grader.evidence.evidence import Evidence

    Findings = Mapping[str, Finding]
    Clocks = Mapping[str, Clock]

UNREAD = Clock("wall", "the source could not be read")


@dataclass
class Judging:
    """Judges one submission, and chooses the clock with which each trial starts. `choice` is the value of `--clock`."""

    choice: ClockChoice
    fault: Fault | None = None
    """The reason why the submission could not be read, or None."""
    _clocks: Clocks = field(default_factory=dict)
    """The first clock of each trial, by its id."""

    def early(self, evidence: Evidence) -> Early:
        """Return the results that are already certain from the files alone."""
        load_catkin_pkg()  # several of the child processes need catkin_pkg
        try:
            early, self._clocks = read(_early, evidence, self.choice)
        except UnreadableError as error:
            self._give_up(error)
            return Early((), frozenset(spec.id for spec in evidence.exercise.checks))
        return early

    def so_far(self, evidence: Evidence, settled: Findings) -> Judgement:
        """Judge the evidence that exists at this stage of grading.

        Checks that already have a finding in `settled` are not run again.
        """
        if self.fault is None:
            if all(spec.id in settled for spec in evidence.exercise.checks):
                return Judgement(evidence.exercise, settled, settled)
            try:
                findings, stand, clocks = read(_all, evidence, settled, self.choice)
            except UnreadableError as error:
                self._give_up(error)
            else:
                self._clocks = {**self._clocks, **clocks}
                return Judgement(evidence.exercise, findings, stand)
        return judge_so_far(self.known(evidence), {})

    def first_clock(self, evidence: Evidence) -> Clock:
        """Return the clock with which this trial starts.

        Before the build, the entry point in setup.py determines the clock. After the build, the installed entry point
        does.
        """
        return self._clocks.get(evidence.trial.id, UNREAD)

    def known(self, evidence: Evidence) -> Evidence:
        """Return the evidence. If the submission could not be read, the `fault` of the evidence contains the reason."""
        return evidence if self.fault is None else dataclasses.replace(evidence, fault=self.fault)

    def _give_up(self, error: UnreadableError) -> None:
        self.fault = Fault("source", in_words(error), unreadable=True)


def _early(evidence: Evidence, choice: ClockChoice) -> tuple[Early, Clocks]:
    return judge_early(evidence), _first_clocks(evidence, choice)


def _all(evidence: Evidence, settled: Findings, choice: ClockChoice) -> tuple[Findings, Findings, Clocks]:
    judgement = judge_so_far(evidence, settled)
    clocks = {} if evidence.runs else _first_clocks(evidence, choice)
    return judgement.findings, judgement.settled, clocks


def _first_clocks(evidence: Evidence, choice: ClockChoice) -> Clocks:
    if not evidence.exercise.package:
        return {}
    trials = [spec for spec in evidence.exercise.trials if spec.tests is None]
    clocks = {spec.id: first_clock(choice, evidence.from_trial(spec.id)) for spec in trials}
    # If one of the nodes in a trial may follow wall time, the whole trial runs in wall time.
    wall = {spec.beside: clocks[spec.id] for spec in trials if spec.beside and clocks[spec.id].name == "wall"}
    return clocks | wall
