"""Grade one submission: build it, run it, and judge what was observed.

This module connects the other parts of the grader.
"""

from __future__ import annotations

import dataclasses
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from grader.checks.judge import in_words
from grader.checks.outcome import Status
from grader.colcon import runner
from grader.colcon.rebuild import Rebuild
from grader.common.system_errors import refusal
from grader.errors import MachineError
from grader.evidence.evidence import Evidence, Fault
from grader.grading.explain import explain
from grader.grading.judging import Judging
from grader.grading.stopwatch import Stopwatch
from grader.grading.tests import Tests
from grader.grading.trials import Trials
from grader.grading.turns import Turns
from grader.grading.turns import folder as turns_folder
from grader.report.report import report_of
from grader.ros import underlay
from grader.ros.installation import find_ros
from grader.sandbox.limits import require_memory, require_processes
from grader.trial.ahead import Ahead
from grader.trial.trial import Plan, Trial

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence
    from pathlib import Path

    from grader.checks.judge import Early
    from grader.checks.outcome import Finding, Outcome
    from grader.evidence.stage import Stage
    from grader.exercise.model import Exercise
    from grader.grading.options import Options
    from grader.report.report import Report
    from grader.ros.installation import Ros
    from grader.submission.package import Submission


@dataclass(frozen=True)
class Graded:
    """A report and the evidence on which it is based.

    `prefixes` are the folders in which the message types are installed.
    """

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
    build: Callable[..., runner.Built] = runner.build,
    trial: Callable[..., Trial] = Trial,
) -> Graded:
    """Grade a submission.

    `tell` is called with a short message about each step. `early` is called before the build, with the outcomes of the
    checks that are certain to fail. A fault of the machine in the build or in a trial raises no exception: the affected
    outcomes have the status `error`. A caller can replace `build` and `trial`: `grader watch`, for example, reuses the
    last build and starts trials in advance.

    Raises:
        MachineError: the submission cannot be judged, because the machine is too busy or a module is missing.
    """
    turns = Turns(turns_folder(), tell)
    rebuild = Rebuild(build)
    with turns.shared():
        graded = _Grading(exercise, submission, options, tell, early, rebuild, trial, turns).run()
    return explained(graded, options, tell, build=rebuild, trial=trial) if options.explain else graded


def can_be_explained(graded: Graded) -> bool:
    """Return whether a failed check has a fix to test. If the first trial ran in wall time, no fix is tested."""
    report = graded.report
    return report.clock != "wall" and any(outcome.finding.fix for outcome in report.with_status(Status.FAILED))


def explained(
    graded: Graded,
    options: Options,
    tell: Callable[[str], None] = lambda _: None,
    *,
    build: Rebuild,
    trial: Callable[..., Trial] = Trial,
    give_up: Callable[[], bool] = lambda: False,
) -> Graded:
    """Test the causes of failed checks, if possible, by fixing the causes in a copy of the submission.

    Return the submission's report and evidence, with the results of the tests.

    `give_up` is called before each change is tested. Once `give_up` returns true, no more changes are tested. `build`
    contains the result of the last build.
    """
    report, evidence = graded.report, graded.evidence
    if not can_be_explained(graded):
        return graded
    again = dataclasses.replace(options, clock="simulated", explain=False)

    def regrade(exercise: Exercise, submission: Submission) -> tuple[Outcome, ...]:
        tell("Trying to fix the cause")
        return grade(exercise, submission, again, build=build, trial=in_simulated_time).report.outcomes

    def in_simulated_time(plan: Plan, *rest: Any, **more: Any) -> Trial:  # noqa: ANN401 - the arguments of Trial
        """Create a trial in simulated time.

        If the corrected node seems to follow wall time, the test of the fix is inconclusive.
        """
        if plan.clock == "wall":
            raise MachineError("The fix for a cause is tested only in simulated time.")  # noqa: EM101
        return trial(dataclasses.replace(plan, stop_at_doubt=True), *rest, **more)

    begun = time.monotonic()
    tries = explain(evidence, report.outcomes, build.build_s, regrade, give_up)
    evidence = dataclasses.replace(evidence, tries=tries)
    seconds = {**report.seconds, "explain": time.monotonic() - begun}
    explained = report_of(evidence, report.outcomes, report.ros, seconds, confined=report.confined)
    return dataclasses.replace(graded, report=explained, evidence=evidence)


@dataclass
class _Grading:
    """The grading of one submission. `settled` maps the ids of checks to findings that no later stage can change."""

    exercise: Exercise
    submission: Submission
    options: Options
    tell: Callable[[str], None]
    early: Callable[[Sequence[Outcome]], object]
    build: Callable[..., runner.Built]
    trial: Callable[..., Trial]
    turns: Turns
    stage: Stage = "build"
    stopwatch: Stopwatch = field(default_factory=Stopwatch)
    settled: Mapping[str, Finding] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.evidence = Evidence(self.exercise, self.submission)
        self.judging = Judging(self.options.clock)
        self.ros: Ros | None = None

    def run(self) -> Graded:
        begun = time.monotonic()
        with self.stopwatch.stage("files"):
            certain = self.judging.early(self.evidence)
        self.early(certain.failed)
        if self.judging.fault is None:
            self._run_all(certain)
        evidence = self.evidence.from_trial(self.exercise.trials[0].id)
        with self.stopwatch.stage("checks"):
            outcomes = self.judging.so_far(evidence, self.settled).outcomes
            evidence = self.judging.known(evidence)
        self.stopwatch.add("in all", time.monotonic() - begun)
        confined = self.options.in_cell or evidence.build is None
        name, prefixes = (self.ros.name, self.ros.all_prefixes) if self.ros is not None else ("none", ())
        report = report_of(evidence, outcomes, name, self.stopwatch.seconds, confined=confined)
        return Graded(report, evidence, prefixes)

    def _run_all(self, certain: Early) -> None:
        """Build the submission and run its trials. An error is stored as the `fault` of the evidence."""
        try:
            require_memory()
            require_processes()
            self.ros = find_ros()
            with self.stopwatch.stage("interfaces"):
                ros = self.ros = underlay.with_turtlesim(self.ros, self.tell)
            if self.exercise.package:
                self._build_and_run(ros, certain)
            else:
                self._run_simulator(ros)
        except MachineError as error:
            self.evidence = dataclasses.replace(self.evidence, fault=Fault(self.stage, str(error)))
        except Exception as error:
            # Either the machine refused an operation, or the submission caused the error.
            refused = refusal(error)
            fault = Fault(self.stage, refused) if refused else Fault(self.stage, in_words(error), unreadable=True)
            self.evidence = dataclasses.replace(self.evidence, fault=fault)

    def _run_simulator(self, ros: Ros) -> None:
        """Run the simulator without a node, for an exercise whose answers are compared with its recording."""
        self.stage = "trial"
        self.tell("Running the simulator")
        self.evidence = self._trials(ros, Ahead(1)).run_alone(self.evidence).evidence

    def _build_and_run(self, ros: Ros, certain: Early) -> None:
        with Ahead(self.options.trials_at_once) as ahead, self._tests(ros) as tests:
            trials = self._trials(ros, ahead)
            views = _longest_first(self.evidence)
            beside = views if self.options.trials_at_once > 1 else views[:1]
            trials.start(view for view in beside if certain.may_run(view))
            if self.options.trials_at_once > 1:
                tests.start(view for view in self._views_of_tests() if certain.may_run(view))
            trials.run_predicted(self.evidence)
            with self.stopwatch.stage("build"):
                built = self.build(self.submission, ros, in_cell=self.options.in_cell, tell=self.tell)
            self.evidence = dataclasses.replace(self.evidence, build=built.build)
            self.stage = "trial"
            judgement = self.judging.so_far(self.evidence, {})
            wanted = [view for view in _longest_first(self.evidence) if judgement.wants(view.trial.id)]
            trials.run_ahead(wanted, built.tree)
            for spec in (each for each in self.exercise.trials if not each.beside):
                self.settled = judgement.settled
                if judgement.wants(spec.id):
                    runs = trials if spec.tests is None else tests
                    attempt = runs.run(self.evidence.from_trial(spec.id), self.settled)
                    self.evidence, judgement = attempt.evidence, attempt.judgement
            self.settled = judgement.settled

    def _views_of_tests(self) -> list[Evidence]:
        return [self.evidence.from_trial(spec.id) for spec in self.exercise.trials if spec.tests is not None]

    def _tests(self, ros: Ros) -> Tests:
        return Tests(ros, self.options, self.judging, self.stopwatch, self.tell)

    def _trials(self, ros: Ros, ahead: Ahead) -> Trials:
        return Trials(self.trial, ros, self.options, self.judging, ahead, self.turns, self.stopwatch, self.tell)


def _longest_first(evidence: Evidence) -> list[Evidence]:
    """Return the evidence of each trial, except trials of tests and trials that run beside another trial.

    The longest trial comes first, so that it does not run alone at the end while other processors are idle.
    """
    specs = evidence.exercise.trials
    views = [evidence.from_trial(spec.id) for spec in specs if spec.tests is None and not spec.beside]
    return sorted(views, key=lambda view: -view.trial.scenario.duration_s)
