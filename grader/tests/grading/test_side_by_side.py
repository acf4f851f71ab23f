"""The trials of an exercise start during its build and run in parallel.

Trials in wall time run after the trials in simulated time.
"""

from __future__ import annotations

import time
from collections import Counter
from dataclasses import dataclass, field, replace
from threading import Barrier
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.exercises import find_exercise
from grader.checks.kinds import KINDS
from grader.checks.outcome import Status
from grader.colcon.runner import Built
from grader.errors import MachineError
from grader.grading.grade import grade
from grader.grading.options import Options
from grader.submission.package import open_submission
from grader.tests.case import ROOT
from grader.tests.checks.made import BUILD, good
from grader.tests.no_ros import without_ros
from grader.tests.waiting import HANG_S, until

if TYPE_CHECKING:
    from pathlib import Path

    from grader.checks.kind import Kind
    from grader.checks.outcome import Finding
    from grader.evidence.evidence import Evidence
    from grader.grading.grade import Graded
    from grader.trial.recording import ClockName, Recording
    from grader.trial.trial import Plan

STEP = "07-challenges"
PACKAGE = "my_robot_controller"
NODES = ("own_circle", "figure_eight", "draw_square", "go_to_goal")
LONGEST = {"own_circle", "go_to_goal"}


@dataclass
class Trials:
    """A replacement for the class `Trial`. `begun` lists the nodes that ran, and `ended` the clocks, in order."""

    open: int = 0
    begun: list[str] = field(default_factory=list)
    ended: list[str] = field(default_factory=list)
    both: Barrier = field(default_factory=lambda: Barrier(2))

    def __call__(self, plan: Plan, *_: object, in_cell: bool) -> Any:  # noqa: ANN401 - a Trial to whoever makes it
        assert not in_cell
        return _Made(self, plan.clock)


@dataclass
class _Made:
    trials: Trials
    clock: ClockName

    def __enter__(self) -> _Made:  # noqa: PYI034 - typing.Self is Python 3.11's
        self.trials.open += 1
        return self

    def __exit__(self, *_: object) -> None:
        self.trials.open -= 1

    def await_ready(self) -> None:
        pass

    def run(self, _package: str, executable: str, _tree: bytes) -> Recording:
        self.trials.begun.append(executable)
        if executable in LONGEST:
            self.trials.both.wait(HANG_S)
        elif executable == "draw_square":
            time.sleep(0.1)  # the last trial to end, unless a caller does not wait for it
        self.trials.ended.append(self.clock)
        return replace(good(), clock=self.clock)


@pytest.fixture(autouse=True)
def nobody_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    without_ros(tmp_path, monkeypatch)


def graded(trials: Trials, at_once: int, build: Any, more: bytes = b"") -> Graded:  # noqa: ANN401
    """Return the graded solution of step 07, with `more` at the end of the file that drives the figure eight."""
    given = open_submission(ROOT / "solutions" / STEP)
    eight = f"{PACKAGE}/figure_eight.py"
    given = replace(given, files={**given.files, eight: given.files[eight] + more})
    options = Options(in_cell=False, trials_at_once=at_once)
    return grade(find_exercise(STEP), given, options, build=build, trial=trials)


@pytest.mark.parametrize(("at_once", "begun"), [(2, 4), (1, 1)])
def test_all_trials_are_started_if_they_may_run_in_parallel(at_once: int, begun: int) -> None:
    trials = Trials()
    observed = []

    def build(*_: object, **__: object) -> Any:  # noqa: ANN401
        until(lambda: trials.open == begun)
        observed.append(trials.open)
        raise MachineError("No compiler.")  # noqa: EM101

    made = graded(trials, at_once, build)
    assert (observed, trials.open) == ([begun], 0)
    assert {outcome.status for outcome in made.report.outcomes} == {Status.PASSED, Status.ERROR}


def built_solution() -> Built:
    """Return the build of the solution without its files."""
    scripts = (ROOT / "solutions" / STEP / PACKAGE / PACKAGE).glob("*.py")
    build = replace(
        BUILD,
        installed=(
            *BUILD.installed,
            *(f"lib/{PACKAGE}/{node}" for node in NODES),
            *(f"lib/python3.11/site-packages/{PACKAGE}/{script.name}" for script in scripts),
        ),
        executables=NODES,
        entry_points={node: f"{PACKAGE}.{node}:main" for node in NODES},
    )
    return Built(build, b"")


def test_the_longest_run_first_and_side_by_side_and_one_by_the_walls_clock_when_they_have_ended() -> None:
    trials = Trials()
    made = graded(trials, 2, lambda *_, **__: built_solution(), b"\nimport time\n\ntime.sleep(0.0)\n")
    assert set(trials.begun[:2]) == LONGEST
    assert trials.ended == ["simulated", "simulated", "simulated", "wall"]
    assert made.report.clock == "simulated"
    assert "; figure_eight in wall time: " in made.report.clock_why


def test_each_check_is_judged_once_when_its_stage_is_done(monkeypatch: pytest.MonkeyPatch) -> None:
    judged: Counter[tuple[str, str]] = Counter()

    def counted(kind: Kind[Any]) -> Kind[Any]:
        def check(given: Evidence, params: object) -> Finding:
            judged[kind.name, f"{given.trial.id} {params}"] += given.build is not None
            return kind.check(given, params)

        return replace(kind, check=check)

    monkeypatch.setattr(
        "grader.submission.reader._Child.inside", True
    )  # a child process could not increase our counter
    monkeypatch.setattr("grader.checks.judge.KINDS", {name: counted(kind) for name, kind in KINDS.items()})
    graded(Trials(), 2, lambda *_, **__: built_solution())
    assert set(+judged) >= {("node_starts", f"{trial.id} NoParams()") for trial in find_exercise(STEP).trials}
    assert set((+judged).values()) == {1}
