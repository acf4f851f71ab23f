"""Nodes run during the build, from the predicted install tree.

The report must be about the tree that colcon installs.
"""

from __future__ import annotations

import io
import tarfile
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import PurePosixPath
from threading import Event
from typing import TYPE_CHECKING, Any

import pytest

from grader.checks.exercises import find_exercise
from grader.checks.outcome import Status
from grader.colcon.predicted import predict
from grader.colcon.runner import Built
from grader.colcon.runner import build as build_with_colcon
from grader.grading import grade as grading
from grader.grading.grade import grade
from grader.grading.options import Options
from grader.ros import underlay
from grader.ros.installation import find_ros
from grader.sandbox import bubblewrap
from grader.submission.package import open_submission
from grader.tests.case import BASES, ROOT, make_submission, read_cases
from grader.tests.catalogue import MISTAKES
from grader.tests.checks.made import BUILD, good
from grader.tests.gradings import EXERCISE
from grader.tests.no_ros import NO_ROS
from grader.tests.sample import lives_in_wall_time, sample
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from pathlib import Path

    from grader.grading.grade import Graded
    from grader.submission.package import Submission
    from grader.tests.case import Case
    from grader.trial.recording import Recording
    from grader.trial.trial import Plan

GNU = tarfile.GNU_FORMAT
ROS = find_ros()
STEP = "03-circle-publisher"
NODE = "my_robot_controller/draw_circle.py"


def exercise_of(case: Case) -> str:
    return case.exercise or case.base or EXERCISE


@cache
def is_built(exercise: str) -> bool:
    """Return whether this exercise has a package, and not only answers."""
    return bool(find_exercise(exercise).package)


ALL = read_cases(MISTAKES)
SAMPLE = sample(ALL)
BUILT = [
    case
    for case in (*ALL, *read_cases(BASES.parent / "unusual"))
    if case.result != "usage" and not lives_in_wall_time(case) and is_built(exercise_of(case))
]
FEW = [case.name for case in BUILT if case.name in SAMPLE][::6]
CASES = [pytest.param(case, id=case.name, marks=() if case.name in FEW else pytest.mark.exhaustive) for case in BUILT]


@dataclass
class Trials:
    """A replacement for the class `Trial`. `trees` are the install trees that a node ran from, in order."""

    trees: list[bytes] = field(default_factory=list)
    clocks: list[str] = field(default_factory=list)
    ran: Event = field(default_factory=Event)

    def __call__(self, plan: Plan, *_: object, in_cell: bool) -> Any:  # noqa: ANN401, ARG002 - a Trial to whoever makes it
        self.clocks.append(plan.clock)
        return _Made(self)


@dataclass
class _Made:
    trials: Trials

    def __enter__(self) -> _Made:  # noqa: PYI034 - typing.Self is Python 3.11's
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def await_ready(self) -> None:
        pass

    def run(self, _package: str, _executable: str, tree: bytes) -> Recording:
        self.trials.trees.append(tree)
        self.trials.ran.set()
        return good()


@dataclass
class Build:
    """A replacement for colcon.

    This replacement installs the predicted files with `more` at the end of the node's file.

    `trees` contains the install tree that the replacement returned, and `ran` says whether a node ran before the
    replacement returned.
    """

    trials: Trials
    more: bytes = b""
    waits_s: float = 0.0
    tree: bytes = b""
    ran: bool = False

    def __call__(self, submission: Submission, *_: object, **__: object) -> Built:
        self.ran = self.trials.ran.wait(self.waits_s)
        predicted = predict(submission, ROS, [])
        assert predicted is not None
        installed = {
            path: (content + (self.more if path.endswith(NODE) else b""), mode)
            for path, (content, mode) in predicted.files.items()
        }
        self.tree = _with_folders(replace(predicted, files=installed).tree)
        return Built(BUILD, self.tree)


def _with_folders(tree: bytes) -> bytes:
    """Return the tree with the folders of its files, as tar(1) writes them."""
    stream = io.BytesIO()
    with tarfile.open(fileobj=io.BytesIO(tree)) as old, tarfile.open(fileobj=stream, mode="w", format=GNU) as new:
        members = old.getmembers()
        for folder in sorted({str(folder) for each in members for folder in PurePosixPath(each.name).parents}):
            member = tarfile.TarInfo(folder)
            member.type, member.mode = tarfile.DIRTYPE, 0o755
            new.addfile(member)
        for member in members:
            new.addfile(member, old.extractfile(member))
    return stream.getvalue()


def graded(build: Build, more: bytes = b"", *, in_cell: bool = True, at_once: int = 2, clock: Any = "auto") -> Graded:  # noqa: ANN401
    """Grade the solution, with `more` at the end of the node's file, without starting a process."""
    given = open_submission(ROOT / "solutions" / STEP)
    given = replace(given, files={**given.files, NODE: given.files[NODE] + more})
    options = Options(in_cell=in_cell, clock=clock, trials_at_once=at_once)
    return grade(find_exercise(STEP), given, options, build=build, trial=build.trials)


@pytest.fixture
def no_interfaces(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Do not build the turtlesim interfaces, and do not wait for other graders on this machine."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setattr(underlay, "ensure", lambda *_: None)


@pytest.mark.usefixtures("no_interfaces")
def test_a_usual_node_runs_once_and_during_the_build() -> None:
    build = Build(Trials(), waits_s=HANG_S)
    graded(build)
    assert build.ran
    assert len(build.trials.trees) == 1


@pytest.mark.usefixtures("no_interfaces")
def test_it_runs_again_if_colcon_installs_something_else() -> None:
    build = Build(Trials(), b"# changed by setup.py\n", HANG_S)
    graded(build)
    assert build.ran
    assert len(build.trials.trees) == 2
    assert build.trials.trees[1] == build.tree


@pytest.mark.usefixtures("no_interfaces")
@pytest.mark.parametrize(
    ("more", "options"),
    [
        pytest.param(b"", {"in_cell": False}, id="without cells"),
        pytest.param(b"", {"at_once": 1}, id="on one processor"),
        pytest.param(b"", {"clock": "wall"}, id="in wall time"),
        pytest.param(b"\nimport os\n", {}, id="an unusual node"),
    ],
)
def test_otherwise_it_runs_after_the_build(more: bytes, options: dict[str, Any]) -> None:
    build = Build(Trials(), waits_s=0.2)
    graded(build, more, **options)
    assert not build.ran
    assert build.trials.trees == [build.tree]


@pytest.mark.usefixtures("no_interfaces")
def test_nothing_is_predicted_without_ros(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(grading, "find_ros", lambda: NO_ROS)
    build = Build(Trials(), waits_s=0.2)
    graded(build)
    assert not build.ran
    assert build.trials.trees == [build.tree]


def both_ways(exercise: str, given: Submission) -> list[Any]:
    """Return the important parts of two reports: with a run during the build, and without such a run.

    The two reports use the same build.
    """
    if not bubblewrap.usable():
        pytest.skip("without a sandbox, no node runs during the build")
    built: list[Built] = []

    def build(*arguments: Any, **options: Any) -> Built:  # noqa: ANN401
        if not built:
            built.append(build_with_colcon(*arguments, **options))
        return built[0]

    reports = [
        grade(find_exercise(exercise), given, Options(in_cell=True, trials_at_once=at_once), build=build).report
        for at_once in (2, 1)
    ]
    return [
        ([(o.id, o.status, o.points, o.finding.diagnosis, o.finding.cause) for o in r.outcomes], r.clock)
        for r in reports
    ]


def test_a_setup_py_that_changes_the_node_gets_the_report_of_the_changed_node() -> None:
    """The arguments of setup() can contain code, and the prediction does not run this code."""
    given = open_submission(ROOT / "solutions" / STEP)
    setup_py = given.files["setup.py"].decode()
    change = f'open("{NODE}", "a").write("\\nraise RuntimeError(7)\\n")'
    changing = setup_py.replace('license="MIT"', f"license=str({change})")
    assert changing != setup_py
    during, after = both_ways(STEP, replace(given, files={**given.files, "setup.py": changing.encode()}))
    assert during == after
    assert [status for _, status, *_ in during[0] if status is Status.FAILED], during


@pytest.mark.parametrize("case", CASES)
def test_the_report_is_the_same_with_and_without_a_run_during_the_build(case: Case, tmp_path: Path) -> None:
    given = open_submission(make_submission(case, tmp_path / "in"))
    during, after = both_ways(exercise_of(case), given)
    if during[0] == after[0]:
        # A busy machine can make one of the two nodes look like a node that follows wall time, but not twice in a row.
        during, after = (during, after) if during == after else both_ways(exercise_of(case), given)
    assert during == after
