"""Grade one submission: build it, run it, judge what was seen. The one place where all parts meet."""

from __future__ import annotations

import dataclasses
import os
import time
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import grader
from grader.checks.judge import in_words, near_edge, of_this_trial, wants_trial
from grader.checks.kinds import KINDS
from grader.checks.outcome import Status
from grader.colcon import workspace
from grader.common.refusal import refusal
from grader.common.words import printable
from grader.errors import MachineError
from grader.evidence.evidence import Evidence, Fault, Run
from grader.grading.judging import Judging
from grader.grading.turns import Turns
from grader.grading.turns import folder as turns_folder
from grader.report.report import Report
from grader.ros import underlay
from grader.ros.installation import find_ros
from grader.trial.ahead import Ahead
from grader.trial.inputs import draw_inputs
from grader.trial.start import start_pose
from grader.trial.trial import OverwhelmedError, Plan, Trial, WallTimeNeeded

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from grader.checks.judge import Early
    from grader.checks.outcome import Outcome
    from grader.evidence.stage import Stage
    from grader.exercise.model import CheckSpec, Exercise
    from grader.ros.installation import Ros
    from grader.submission.package import Submission
    from grader.trial.ahead import Runs
    from grader.trial.recording import ClockName, Recording

ClockChoice = Literal["auto", "simulated", "wall"]

WALL_TRIALS = 3
"""How often at most a wall-clock trial is made that failed while the machine was busy with other things."""

USUAL_RADIUS_M = 2.0
"""A drawn start leaves room for a circle of this radius where no check asks for another."""

UNASKED_SEED = 1
"""What is drawn from where nobody asked for a seed, in scenarios that vary all the same."""


@dataclass(frozen=True)
class Options:
    """How to grade: `in_cell` confines the student's code (grader.sandbox).

    `trials_at_once` of an exercise with several run side by side: one where other gradings keep the processors busy.
    """

    in_cell: bool
    clock: ClockChoice = "auto"
    seed: int | None = None
    trials_at_once: int = field(default_factory=lambda: len(os.sched_getaffinity(0)))


@dataclass(frozen=True)
class Graded:
    """The report, and what it was judged from. `prefixes` hold the installed message types."""

    report: Report
    evidence: Evidence
    prefixes: tuple[Path, ...]


def grade(
    exercise: Exercise,
    submission: Submission,
    options: Options,
    tell: Callable[[str], None] = lambda _: None,
    *,
    early: Callable[[Sequence[Outcome]], object] = lambda _: None,
    build: Callable[..., workspace.Built] = workspace.build,
    trial: Callable[..., Trial] = Trial,
) -> Graded:
    """Grade a submission; `tell` hears in a few words what is being done, `early` what failed for certain before that.

    A fault of the machine becomes outcomes of status `error`, never an exception. `build` and `trial` stand in for
    what they are named after: `grader watch` has builds and trials that it began before.
    """
    turns = Turns(turns_folder())
    with turns.shared():
        ahead = Ahead(options.trials_at_once)
        return _Grading(exercise, submission, options, tell, early, build, trial, turns, ahead).run()


def report_of(
    evidence: Evidence, outcomes: tuple[Outcome, ...], ros: str, seconds: dict[str, float], *, confined: bool = True
) -> Report:
    """The report on evidence that has been judged."""
    recording = evidence.run.recording
    return Report(
        exercise=evidence.exercise.id,
        exercise_title=evidence.exercise.title,
        submission=evidence.submission.name,
        digest=evidence.submission.digest,
        grader=grader.__version__,
        ros=ros,
        clock=recording.clock if recording else "none",
        clock_why=_why_this_clock(evidence),
        seed=recording.seed if recording else None,
        confined=confined,
        outcomes=outcomes,
        seconds=seconds,
        exercise_digest=evidence.exercise.digest,
    )


@dataclass
class _Grading:
    exercise: Exercise
    submission: Submission
    options: Options
    tell: Callable[[str], None]
    early: Callable[[Sequence[Outcome]], object]
    builder: Callable[..., workspace.Built]
    trials: Callable[..., Trial]
    turns: Turns
    ahead: Ahead
    judging: Judging = field(default_factory=Judging)
    seconds: dict[str, float] = field(default_factory=dict)
    tree: bytes = b""
    """What was built, as a tar stream."""

    def run(self) -> Graded:
        begun = time.monotonic()
        evidence = Evidence(self.exercise, self.submission)
        ros_name = "none"
        prefixes: tuple[Path, ...] = ()
        with self._timed("files"):
            certain = self.judging.early(evidence)
        self.early(certain.failed)
        if self.judging.fault is None:
            evidence, ros_name, prefixes = self._run_all(evidence, certain)
        with self._timed("checks"):
            outcomes = self.judging.outcomes(evidence)
            evidence = self.judging.known(evidence)
        self.seconds["in all"] = time.monotonic() - begun
        confined = self.options.in_cell or evidence.build is None
        report = report_of(evidence, outcomes, ros_name, self.seconds, confined=confined)
        return Graded(report, evidence, prefixes)

    def _run_all(self, evidence: Evidence, certain: Early) -> tuple[Evidence, str, tuple[Path, ...]]:
        """The evidence with build and trials, the ROS 2 that ran them, and what holds the message types."""
        ros_name = "none"
        prefixes: tuple[Path, ...] = ()
        stage: Stage = "build"
        try:
            ros = find_ros()
            ros_name = ros.name
            with self._timed("interfaces"):
                ros = underlay.with_turtlesim(ros, self.tell)
            prefixes = ros.all_prefixes
            if not self.exercise.package:
                stage = "trial"
                evidence = self._simulator_alone(evidence, ros)
            else:
                with self.ahead:
                    self._start_trials(evidence, certain, ros)
                    evidence = self._build(evidence, ros)
                    stage = "trial"
                    self._run_ahead(evidence)
                    for spec in self.exercise.trials:
                        if self._wants_trial(evidence.from_trial(spec.id)):
                            evidence = self._run_trial(evidence.from_trial(spec.id), ros)
                    evidence = evidence.from_trial(self.exercise.trials[0].id)
        except MachineError as error:
            evidence = dataclasses.replace(evidence, fault=Fault(stage, str(error)))
        except Exception as error:
            # What the machine has not refused, the submission has made.
            refused = refusal(error)
            fault = Fault(stage, refused) if refused else Fault(stage, in_words(error), unreadable=True)
            evidence = dataclasses.replace(evidence, fault=fault)
        return evidence, ros_name, prefixes

    def _simulator_alone(self, evidence: Evidence, ros: Ros) -> Evidence:
        self.tell("Asking a running simulator")
        with self._timed("trial"), self._trial(evidence, "simulated", ros) as trial:
            recording = trial.run_alone()
        why = "the simulator ran by itself, and says the same at any pace"
        return evidence.with_run(Run(dataclasses.replace(recording, why=why)))

    def _start_trials(self, evidence: Evidence, certain: Early, ros: Ros) -> None:
        """Start simulators and launchers beside the build, of all trials or one; none for a node that cannot run."""
        for seen in _longest_first(evidence) if self.options.trials_at_once > 1 else (evidence,):
            if certain.may_run(seen):
                clock, _ = self._first_clock(seen)
                self.ahead.start(seen.trial.id, self._trial(seen, clock, ros))

    def _run_ahead(self, evidence: Evidence) -> None:
        """Let the nodes begin whose trials pass in simulated time."""
        for seen in _longest_first(evidence):
            name = seen.trial.id
            if self.ahead.trial(name) and self._first_clock(seen)[0] == "simulated" and self._wants_trial(seen):
                self.ahead.run(name, _package(seen), seen.trial.executable, self.tree)

    def _run_trial(self, evidence: Evidence, ros: Ros) -> Evidence:
        """The evidence with what this trial showed, which ends here."""
        clock, why = self._first_clock(evidence)
        begun = self.ahead.trial(evidence.trial.id)
        with nullcontext(begun) if begun else self._trial(evidence, clock, ros) as trial:
            return self._try_twice(evidence, trial, clock, why, ros)

    def _first_clock(self, evidence: Evidence) -> tuple[ClockName, str]:
        if self.options.clock != "auto":
            return self.options.clock, f"asked for with --clock {self.options.clock}"
        return self.judging.first_clock(evidence)

    def _wants_trial(self, evidence: Evidence) -> bool:
        return wants_trial(evidence, self.judging.outcomes(evidence))

    def _of_this_trial(self, evidence: Evidence) -> tuple[Outcome, ...]:
        return of_this_trial(evidence, self.judging.outcomes(evidence))

    def _passed(self, evidence: Evidence) -> bool:
        return all(outcome.status is Status.PASSED for outcome in self._of_this_trial(evidence))

    def _build(self, evidence: Evidence, ros: Ros) -> Evidence:
        with self._timed("build"):
            built = self.builder(self.submission, ros, in_cell=self.options.in_cell, tell=self.tell)
        self.tree = built.tree
        return dataclasses.replace(evidence, build=built.build)

    def _try_twice(self, evidence: Evidence, trial: Runs, clock: ClockName, why: str, ros: Ros) -> Evidence:
        """A node that brings the simulator down once may have met a fault of the machine; twice, it is the node.

        One that kept it busy for minutes gets no second try: a class would wait too long.
        """
        try:
            return self._try(evidence, trial, clock, why, ros)
        except OverwhelmedError as error:
            if error.hung:
                return evidence.with_run(Run(overwhelmed=str(error)))
            self.tell(f"The simulator was brought down ({printable(str(error))}): once more")
        try:
            with self._trial(evidence, clock, ros) as again:
                return self._try(evidence, again, clock, why, ros)
        except OverwhelmedError as error:
            return evidence.with_run(Run(overwhelmed=str(error)))

    def _try(self, evidence: Evidence, trial: Runs, clock: ClockName, why: str, ros: Ros) -> Evidence:
        """Run the trial under the first clock, and under the wall's when that one must judge."""
        if clock == "simulated":
            try:
                evidence = self._run(evidence, trial, clock, why)
            except WallTimeNeeded as doubt:
                why = str(doubt)
            else:
                if self.options.clock == "simulated" or not near_edge(self._of_this_trial(evidence)):
                    return evidence
                why = "a measured value lies near the edge of what is allowed, where only the wall's clock decides"
            with self._trial(evidence, "wall", ros) as again:
                evidence = self._run(evidence, again, "wall", why)
        else:
            evidence = self._run(evidence, trial, "wall", why)
        return self._not_starved(evidence, why, ros)

    def _not_starved(self, evidence: Evidence, why: str, ros: Ros) -> Evidence:
        """Repeat a wall-clock trial that failed while others used the machine, now without other gradings beside it.

        A busy machine makes a right node look wrong, never a wrong one right: the first trial that passes counts, else
        the one that was disturbed least.
        """
        tried = [evidence]
        while len(tried) < WALL_TRIALS and _disturbed(tried[-1]) and not self._passed(tried[-1]):
            self.tell("The machine was too busy for wall time: once more")
            with self.turns.alone(), self._trial(evidence, "wall", ros) as trial:
                tried.append(self._run(evidence, trial, "wall", why))
        return tried[-1] if self._passed(tried[-1]) else min(tried, key=_disturbance)

    def _run(self, evidence: Evidence, trial: Runs, clock: ClockName, why: str) -> Evidence:
        duration_s = evidence.trial.scenario.duration_s
        simulated = clock == "simulated"
        if not simulated:
            self.ahead.settle()
        self.tell(f"Running {duration_s:g} s of simulated time" if simulated else f"Running {duration_s:g} s ({why})")
        with self._timed("trial"):
            recording = trial.run(_package(evidence), evidence.trial.executable, self.tree)
        self._split(recording)
        return evidence.with_run(Run(dataclasses.replace(recording, why=why)))

    def _split(self, recording: Recording) -> None:
        for part, seconds in recording.seconds.items():
            if part != "start":
                self.seconds[part] = self.seconds.get(part, 0.0) + seconds

    def _trial(self, evidence: Evidence, clock: ClockName, ros: Ros) -> Trial:
        exercise, scenario = self.exercise, evidence.trial.scenario
        checks = [check for check in exercise.checks if check.trial == evidence.trial.id]
        radii = [KINDS[check.kind].radius(check.params) for check in checks]
        radius = max((each for each in radii if each is not None), default=USUAL_RADIUS_M)
        seed = self.options.seed
        start = start_pose(UNASKED_SEED if seed is None and scenario.anywhere else seed, radius)
        plan = Plan(
            clock=clock,
            start=start,
            seed=seed,
            duration_s=scenario.duration_s,
            alone=not exercise.package,
            inputs=draw_inputs(scenario, start, UNASKED_SEED if seed is None else seed),
            stop_at_doubt=self.options.clock == "auto",
            judged=_topics(checks),
        )
        return self.trials(plan, ros, in_cell=self.options.in_cell)

    @contextmanager
    def _timed(self, stage: str) -> Iterator[None]:
        begun = time.monotonic()
        try:
            yield
        finally:
            self.seconds[stage] = self.seconds.get(stage, 0.0) + time.monotonic() - begun


def _topics(checks: Sequence[CheckSpec]) -> tuple[str, ...]:
    """The topics that these checks ask for: every name that begins with a slash, since some of them are topics."""
    names = {value for check in checks for value in check.params.values() if isinstance(value, str)}
    return tuple(sorted(name for name in names if name.startswith("/")))


def _longest_first(evidence: Evidence) -> list[Evidence]:
    """The evidence as each of the exercise's trials sees it, in the order in which none is left to run alone."""
    views = [evidence.from_trial(spec.id) for spec in evidence.exercise.trials]
    return sorted(views, key=lambda seen: -seen.trial.scenario.duration_s)


def _package(evidence: Evidence) -> str:
    build = evidence.build
    assert build is not None
    assert build.package is not None
    return build.package


def _why_this_clock(evidence: Evidence) -> str:
    """Why the first trial was judged under its clock, and which others were judged under another."""
    first = evidence.run.recording
    if first is None:
        return _why_not_run(evidence)
    others = [(seen.trial.executable, seen.run.recording) for seen in evidence.views()]
    differ = [(name, other) for name, other in others if other is not None and other.clock != first.clock]
    return "; ".join([first.why, *(f"{name} in {other.clock} time: {other.why}" for name, other in differ)])


def _why_not_run(evidence: Evidence) -> str:
    return "The node was not run." if evidence.run.overwhelmed is None else "The trial could not be finished."


def _disturbed(evidence: Evidence) -> bool:
    return _disturbance(evidence) > (False, 0.0)


def _disturbance(evidence: Evidence) -> tuple[bool, float]:
    return evidence.recording.crowded, evidence.recording.stalled_s
