"""How many trials of an exercise are begun beside its build."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from grader import grade as grading
from grader import underlay
from grader.errors import MachineError
from grader.exercise import find_exercise
from grader.grade import Options, grade
from grader.outcome import Status
from grader.ros import Ros
from grader.submission import open_submission
from grader.tests.case import ROOT

STEP = "07-challenges"
NO_ROS = Ros("wheels", "0", Path("/"), (), Path("python3"), (), ())


class Started:
    """Stands in for the class of trials, and counts those that are open."""

    def __init__(self) -> None:
        self.open = 0

    def __call__(self, *_: object, in_cell: bool) -> Any:  # noqa: ANN401 - a Trial to whoever makes it
        assert not in_cell
        return self

    def __enter__(self) -> Started:  # noqa: PYI034 - typing.Self is Python 3.11's
        self.open += 1
        return self

    def __exit__(self, *_: object) -> None:
        self.open -= 1


@pytest.mark.parametrize(("at_once", "begun"), [(2, 4), (1, 1)])
def test_all_are_begun_where_they_may_run_side_by_side(
    at_once: int, begun: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(grading, "find_ros", lambda: NO_ROS)
    monkeypatch.setattr(underlay, "ensure", lambda *_: None)
    trials, seen = Started(), []

    def build(*_: object, **__: object) -> Any:  # noqa: ANN401
        seen.append(trials.open)
        raise MachineError("No compiler.")  # noqa: EM101

    options = Options(in_cell=False, trials_at_once=at_once)
    graded = grade(find_exercise(STEP), open_submission(ROOT / "solutions" / STEP), options, build=build, trial=trials)
    assert (seen, trials.open) == ([begun], 0)
    assert {outcome.status for outcome in graded.report.outcomes} == {Status.PASSED, Status.ERROR}
