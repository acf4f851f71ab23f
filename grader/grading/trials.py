"""The trials of a submission: start them during the build, run them, and repeat them if the clock rules require it."""

from __future__ import annotations

import dataclasses
from contextlib import nullcontext, suppress
from typing import TYPE_CHECKING

from grader.colcon.comparison import installs
from grader.colcon.predicted import predict
from grader.common.words import printable
from grader.errors import UnreadableError
from grader.evidence.evidence import Run
from grader.grading import clock as policy
from grader.grading.calls import call
from grader.grading.clock import ALONE, Attempt
from grader.grading.plan import executables_of, plan_of
from grader.submission.reader import read
from grader.trial.trial import OverwhelmedError, WallTimeNeeded

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from grader.checks.outcome import Finding
    from grader.colcon.predicted import Predicted
    from grader.evidence.evidence import Evidence
    from grader.grading.clock import Clock
    from grader.grading.judging import Judging
    from grader.grading.options import Options
    from grader.grading.stopwatch import Stopwatch
    from grader.grading.turns import Turns
    from grader.ros.installation import Ros
    from grader.trial.ahead import Ahead, Runs
    from grader.trial.recording import ClockName
    from grader.trial.trial import Trial


class Trials:
    """Creates and runs the trials of one submission. `tree` is the submission's install tree (a tar stream)."""

    def __init__(
        self,
        make: Callable[..., Trial],
        ros: Ros,
        options: Options,
        judging: Judging,
        ahead: Ahead,
        turns: Turns,
        stopwatch: Stopwatch,
        tell: Callable[[str], None],
    ) -> None:
        self._make = make
        self._ros = ros
        self._options = options
        self._judging = judging
        self._ahead = ahead
        self._turns = turns
        self._stopwatch = stopwatch
        self._tell = tell
        self._started: dict[str, ClockName] = {}
        self._predicted: Predicted | None = None
        self.tree = b""

    def start(self, views: Iterable[Evidence]) -> None:
        """Start the simulators and launchers of these trials, except trials without a simulator."""
        for view in (each for each in views if not each.trial.calls):
            name = self._started[view.trial.id] = self._judging.first_clock(view).name
            self._ahead.start(view.trial.id, self._trial(view, name))

    def run_predicted(self, evidence: Evidence) -> None:
        """Start the nodes of the started trials from the predicted install tree, if this tree can be predicted.

        A node in wall time does not start before the build has finished, because the node needs the processors to
        itself.
        """
        views = [evidence.from_trial(id_) for id_, clock in self._started.items() if clock == "simulated"]
        if not views or not self._options.runs_during_build:
            return
        executables = {name for view in views for name in executables_of(view)}
        with suppress(UnreadableError):
            self._predicted = read(predict, evidence.submission, self._ros, executables)
        if self._predicted is not None:
            for view in views:
                self._ahead.run(view.trial.id, self._predicted.package, view.trial.executable, self._predicted.tree)

    def run_ahead(self, views: Sequence[Evidence], tree: bytes) -> None:
        """Start the nodes of trials in simulated time whose simulators are already running.

        Then call `run` to wait for the recording of a trial.

        `tree` is the install tree of the finished build. If the predicted install tree has the same content, the nodes
        that were started from this tree continue to run. Otherwise, their trials start again.
        """
        self.tree = tree
        if self._predicted is not None and not self._is_installed(self._predicted):
            self._ahead.clear()
            self.start(view for view in views if view.trial.id in self._started)
        for view in views:
            if self._judging.first_clock(view).name == "simulated" and self._begun(view) is not None:
                self._ahead.run(view.trial.id, _package(view), view.trial.executable, tree)

    def _is_installed(self, predicted: Predicted) -> bool:
        with suppress(UnreadableError):
            return read(installs, self.tree, predicted)
        return False

    def run(self, evidence: Evidence, settled: Mapping[str, Finding]) -> Attempt:
        """Run this trial. Return the evidence with the recording that counts, and the results of the checks.

        Checks that already have a finding in `settled` are not judged again.

        If the simulator fails once, the machine may be at fault. If the simulator fails twice, the submission's node is
        considered the cause. If a node kept the simulator busy for minutes, the trial is not repeated, because grading
        a class would take too long.
        """
        if evidence.trial.calls:
            return self._call(evidence, settled)
        clock, begun = self._judging.first_clock(evidence), self._begun(evidence)
        try:
            with nullcontext(begun) if begun else self._trial(evidence, clock.name) as trial:
                return self._decide(evidence, trial, clock, settled)
        except OverwhelmedError as error:
            if error.hung:
                return self._overwhelmed(evidence, error, settled)
            self._tell(f"The simulator failed ({printable(str(error))}): running the trial again")
        try:
            with self._trial(evidence, clock.name) as trial:
                return self._decide(evidence, trial, clock, settled)
        except OverwhelmedError as error:
            return self._overwhelmed(evidence, error, settled)

    def _call(self, evidence: Evidence, settled: Mapping[str, Finding]) -> Attempt:
        """Call the function or the program of this trial."""
        name = evidence.trial.executable or evidence.trial.calls.function.rpartition(":")[2]
        self._tell(f"Calling {name}")
        seed, in_cell = self._options.seed, self._options.in_cell
        with self._stopwatch.stage("trial"):
            called = call(evidence.trial, self._ros, _package(evidence), self.tree, seed=seed, in_cell=in_cell)
        return self._attempt(evidence.with_run(Run(called=called)), settled)

    def run_alone(self, evidence: Evidence) -> Attempt:
        """Run the trial's simulator without a node."""
        with self._stopwatch.stage("trial"), self._trial(evidence, ALONE.name) as trial:
            recording = trial.run_alone()
        return self._attempt(evidence.with_run(Run(dataclasses.replace(recording, why=ALONE.why))), {})

    def _begun(self, evidence: Evidence) -> Runs | None:
        """Return the trial that was started during the build, or None if no trial with the right clock was started."""
        fits = self._started.get(evidence.trial.id) == self._judging.first_clock(evidence).name
        return self._ahead.trial(evidence.trial.id) if fits else None

    def _decide(self, evidence: Evidence, trial: Runs, clock: Clock, settled: Mapping[str, Finding]) -> Attempt:
        """Run the trial with its clock, and repeat it in wall time if the rules of clock.py require it."""
        if clock.name == "simulated":
            try:
                attempt = self._run_simulated(evidence, trial, clock, settled)
            except WallTimeNeeded as doubt:
                wall = policy.after_doubt(doubt)
            else:
                after = policy.after_simulated(self._options.clock, attempt)
                if after is None:
                    return attempt
                wall = after
            with self._trial(evidence, wall.name) as again:
                first = self._run(evidence, again, wall, settled)
        else:
            wall = clock
            first = self._run(evidence, trial, wall, settled)
        attempts = [first]
        while policy.wants_another(attempts):
            with self._turns.alone():
                self._tell("The machine was too busy, or its system time was changed: running the trial again")
                with self._trial(evidence, wall.name) as again:
                    attempts.append(self._run(evidence, again, wall, settled))
        return policy.that_counts(attempts)

    def _run_simulated(
        self, evidence: Evidence, trial: Runs, clock: Clock, settled: Mapping[str, Finding], trials: int = 1
    ) -> Attempt:
        """Run the trial in simulated time, and again if it may have been stopped by chance (rule 3).

        This is the trial with the number `trials`.

        Raises:
            WallTimeNeeded: the trial must be repeated in wall time.
        """
        try:
            return self._run(evidence, trial, clock, settled)
        except WallTimeNeeded as doubt:
            if not policy.repeats(doubt, trials):
                raise
        with self._trial(evidence, clock.name) as again:
            return self._run_simulated(evidence, again, clock, settled, trials + 1)

    def _run(self, evidence: Evidence, trial: Runs, clock: Clock, settled: Mapping[str, Finding]) -> Attempt:
        duration_s = evidence.trial.scenario.duration_s
        if clock.name == "simulated":
            self._tell(f"Running {duration_s:g} s of simulated time")
        else:
            self._ahead.settle()
            self._tell(f"Running {duration_s:g} s ({clock.why})")
        with self._stopwatch.stage("trial"):
            recording = trial.run(_package(evidence), evidence.trial.executable, self.tree)
        for part, seconds in recording.seconds.items():
            if part != "start":
                self._stopwatch.add(part, seconds)
        return self._attempt(evidence.with_run(Run(dataclasses.replace(recording, why=clock.why))), settled)

    def _trial(self, evidence: Evidence, clock: ClockName) -> Trial:
        plan = plan_of(evidence, clock, choice=self._options.clock, seed=self._options.seed)
        return self._make(plan, self._ros, in_cell=self._options.in_cell)

    def _attempt(self, evidence: Evidence, settled: Mapping[str, Finding]) -> Attempt:
        return Attempt(evidence, self._judging.so_far(evidence, settled))

    def _overwhelmed(self, evidence: Evidence, error: OverwhelmedError, settled: Mapping[str, Finding]) -> Attempt:
        return self._attempt(evidence.with_run(Run(overwhelmed=str(error))), settled)


def _package(evidence: Evidence) -> str:
    build = evidence.build
    assert build is not None
    assert build.package is not None
    return build.package
