"""Exercise: the task of a step, from course/*/exercise.toml."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from grader.errors import MachineError
from grader.exercise.call_inputs import NO_CALLS, CallsSpec

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.exercise.kind_spec import Param
    from grader.exercise.node_under_test import TestsSpec
    from grader.exercise.own_numbers import NumbersSpec

FILE_NAME = "exercise.toml"


@dataclass(frozen=True)
class CheckSpec:
    """One `[[check]]`. The names of the parameters in `params` include their units, as in `rate_hz` and `radius_m`.

    `trial` is the id of the trial that the check judges.
    """

    id: str
    kind: str
    title: str
    points: float
    needs: tuple[str, ...]
    hidden: bool
    params: Mapping[str, Param]
    trial: str


@dataclass(frozen=True)
class Drive:
    """From `from_s` (s) onwards, until the next drive begins, the simulator drives the turtle.

    Each speed is drawn at random between its two limits.
    """

    from_s: float
    linear_x_m_s: tuple[float, float]
    angular_z_rad_s: tuple[float, float]


Setting = bool | int | float | str
"""The value of a node parameter."""


@dataclass(frozen=True)
class CallInput:
    """A call to a service of the node at `at_s` (s). `type` is the service type, for example "std_srvs/srv/SetBool"."""

    at_s: float
    service: str
    type: str
    request: Mapping[str, Any]


@dataclass(frozen=True)
class StartLimits:
    """The limits of a random start pose: x and y (m) and the heading theta (rad)."""

    x_m: tuple[float, float]
    y_m: tuple[float, float]
    theta_rad: tuple[float, float]


@dataclass(frozen=True)
class Scenario:
    """The events of a trial. After `duration_s` (s) on the clock of the trial, the node receives SIGINT.

    If `anywhere` is set, the start pose is random even without a seed. With `start_limits`, it is random within these
    limits. `rename` contains remapping rules for the simulator, such as "/turtle1/pose:=/where". The pose and the
    colour of a turtle are published every `pose_every` frames. The first pose of turtle1 is published at `pose_from_s`
    (s), as if the simulator had started late. The services of the simulator respond `answers_after_s` (s) after a call.
    The node gets the parameters in `parameters` on its command line, and those in `params_file` from a parameter file.

    If `targets` is not 0, the simulator adds this number of turtles at random places, and the trial itself runs the
    node that announces these turtles (grader/trial/target_keeper.py). If `withdraws` is set, this node removes another
    target after the first catch. If `catch_from_s` is 0, the service of this node exists from the beginning. Otherwise,
    the node creates the service after turtle1 has been near a target or has stood still for a while, but not before
    `catch_from_s` (s). If `alone_s` is set, the trial ends early once the other turtles are gone and turtle1 has been
    alone for this long (s).
    """

    duration_s: float
    drives: tuple[Drive, ...] = ()
    anywhere: bool = False
    start_limits: StartLimits | None = None
    rename: tuple[str, ...] = ()
    pose_every: int = 1
    pose_from_s: float = 0.0
    answers_after_s: float = 0.0
    calls: tuple[CallInput, ...] = ()
    parameters: Mapping[str, Setting] = field(default_factory=dict)
    params_file: Mapping[str, Setting] = field(default_factory=dict)
    targets: int = 0
    withdraws: bool = False
    catch_from_s: float = 0.0
    alone_s: float | None = None


@dataclass(frozen=True)
class TrialSpec:
    """One `[[trial]]`: the executable, the name of its node (without a slash), and the scenario.

    Without an executable, the simulator runs alone. With `calls`, neither a simulator nor a node runs: the function or
    the executable is called once for each call listed. With `tests`, the student's tests run without a simulator.

    If `beside` is the id of another trial, the node of this trial runs in that trial as an additional node, with the
    same scenario. The checks of this trial judge the other trial's recording from the viewpoint of the additional node.
    """

    id: str
    executable: str
    node: str
    scenario: Scenario
    calls: CallsSpec = NO_CALLS
    tests: TestsSpec | None = None
    beside: str = ""


@dataclass(frozen=True)
class Hint:
    """One `[[hint]]`, for some checks or for the whole exercise.

    `part` is the letter of one part of the exercise, such as "b".
    """

    text: str
    checks: tuple[str, ...] = ()
    part: str = ""


@dataclass(frozen=True)
class Exercise:
    """The exercise of a step. The package is built once for all trials.

    The checks judge the files, the build and the trials. Without a `package`, students submit only answers.toml, and
    the simulator runs without a node.
    """

    id: str
    title: str
    package: str
    trials: tuple[TrialSpec, ...]
    """The trials, at least one, in the order of the file."""
    checks: tuple[CheckSpec, ...]
    hints: tuple[Hint, ...]
    folder: Path
    digest: str = ""
    """The SHA-256 hash of exercise.toml, which defines the whole exercise. Private checks are included in the hash."""
    numbers: NumbersSpec | None = None
    """The values that differ from student to student."""
    show_fix: bool = False
    """Whether a student's report shows how the grader changed a copy of the submission to make a failed check pass."""
    unsolved: tuple[str, ...] = ()
    """The checks that the starting point must fail (for `grader validate`). Checks that need one of these checks are
    skipped."""
    apart: bool = False
    """Whether the package has its own workspace. False for the package that grows from step to step."""

    def trial(self, id_: str) -> TrialSpec:
        """Return the trial with this id. Raises KeyError if no trial has this id."""
        return {trial.id: trial for trial in self.trials}[id_]

    def beside(self, id_: str) -> tuple[TrialSpec, ...]:
        """Return the trials whose nodes run in the trial with this id as additional nodes."""
        return tuple(trial for trial in self.trials if trial.beside == id_)


def course_folder() -> Path:
    """Return the folder course/: next to the package in a checkout, or inside the package in an installed wheel.

    Raises MachineError if neither folder contains an exercise.
    """
    package = Path(__file__).resolve().parents[1]
    for folder in (package.parent / "course", package / "course"):
        if any(folder.glob(f"*/{FILE_NAME}")):
            return folder
    message = "The lessons (the folder course/) are missing from this installation of the grader: install it again."
    raise MachineError(message)


def catalogue(course: Path | None = None) -> dict[str, Path]:
    """Return a mapping from the id of each exercise to its exercise.toml, in the order of the lessons.

    No file is parsed. Without `course`, raises the same error as `course_folder`.
    """
    folder = course_folder() if course is None else course
    return {file.parent.name: file for file in sorted(folder.glob(f"*/{FILE_NAME}"))}
