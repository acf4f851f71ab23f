"""Run the student's tests on the correct node and on the broken nodes, if possible during the build."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from grader.checks.own_values import drawn_numbers
from grader.common.words import count
from grader.evidence.evidence import Run
from grader.exercise.own_numbers import OwnNumbers
from grader.grading.clock import Attempt
from grader.submission.reader import read
from grader.testbench.result import BenchResult, runs_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from grader.checks.outcome import Finding
    from grader.evidence.evidence import Evidence
    from grader.exercise.node_under_test import TestsSpec
    from grader.grading.judging import Judging
    from grader.grading.options import Options
    from grader.grading.stopwatch import Stopwatch
    from grader.ros.installation import Ros
    from grader.testbench.bench import Bench


def tests_of(evidence: Evidence) -> TestsSpec:
    """Return the nodes on which the tests run, with the student's own numbers.

    If these numbers cannot be read, the values in the exercise are used. A check then fails, and no test result counts.
    """
    spec = evidence.trial.tests
    assert spec is not None
    drawn = drawn_numbers(evidence) if spec.own else None
    return spec.with_numbers(drawn.values) if isinstance(drawn, OwnNumbers) else spec


class Tests:
    """A context manager that runs the student's tests. All test runs are stopped when the context exits."""

    __test__ = False  # keeps pytest from collecting this class

    def __init__(
        self, ros: Ros, options: Options, judging: Judging, stopwatch: Stopwatch, tell: Callable[[str], None]
    ) -> None:
        self._ros = ros
        self._options = options
        self._judging = judging
        self._stopwatch = stopwatch
        self._tell = tell
        self._started: dict[str, Bench] = {}

    def __enter__(self) -> Tests:  # noqa: PYI034 - typing.Self is Python 3.11's
        return self

    def __exit__(self, *_: object) -> None:
        for bench in self._started.values():
            bench.close()

    def start(self, views: Iterable[Evidence]) -> None:
        """Start the student's tests in each of these trials. The tests do not need the build."""
        for view in views:
            from grader.testbench.bench import Bench  # few exercises have tests

            spec = read(tests_of, view)
            bench = self._started[view.trial.id] = Bench(
                spec,
                view.trial.node,
                view.exercise.package,
                view.submission.files,
                self._ros,
                in_cell=self._options.in_cell,
                lanes=self._options.trials_at_once,
            )
            bench.start()

    def run(self, evidence: Evidence, settled: Mapping[str, Finding]) -> Attempt:
        """Wait for the test runs of this trial.

        Return the evidence with the test results, and the results of the checks.

        Checks that already have a finding in `settled` are not judged again.

        Raises:
            MachineError: the sandbox, pytest or rclpy does not work.
        """
        if evidence.trial.id not in self._started:
            self.start([evidence])
        spec = evidence.trial.tests
        assert spec is not None
        self._tell(f"Running your tests {count(spec.right_runs + len(spec.broken), 'time')}")
        begun = time.monotonic()
        with self._stopwatch.stage("trial"):
            ended = self._started[evidence.trial.id].result()
        runs = read(runs_of, ended)
        evidence = evidence.with_run(Run(bench=BenchResult(runs, time.monotonic() - begun)))
        return Attempt(evidence, self._judging.so_far(evidence, settled))
