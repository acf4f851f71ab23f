"""Exercise: what is to be done in a step, read from course/*/exercise.toml."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from grader.errors import MachineError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.exercise.kind_spec import Param

FILE_NAME = "exercise.toml"


@dataclass(frozen=True)
class CheckSpec:
    """One `[[check]]`: `params` hold its numbers, with units in their names (`rate_hz`, `radius_m`).

    `trial`: the id of the trial that it judges.
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
    """From `from_s` (s) on the simulator itself drives the turtle; each speed is drawn from its two limits."""

    from_s: float
    linear_x_m_s: tuple[float, float]
    angular_z_rad_s: tuple[float, float]


@dataclass(frozen=True)
class Scenario:
    """What a trial does: `duration_s` on the trial's clock, then SIGINT.

    `anywhere`: the turtle starts at a drawn place even without a seed. `rename`: remapping rules of the simulator, as
    "/turtle1/pose:=/where". `pose_every`: it publishes a pose every so many frames.
    """

    duration_s: float
    drives: tuple[Drive, ...] = ()
    anywhere: bool = False
    rename: tuple[str, ...] = ()
    pose_every: int = 1


@dataclass(frozen=True)
class TrialSpec:
    """One `[[trial]]`: the executable that runs, the name of its node (without a slash), and what happens meanwhile.

    Without an executable the simulator runs by itself.
    """

    id: str
    executable: str
    node: str
    scenario: Scenario


@dataclass(frozen=True)
class Hint:
    """One `[[hint]]`: it helps with these checks, or with all of the exercise; `part` is the letter of a part of it."""

    text: str
    checks: tuple[str, ...] = ()
    part: str = ""


@dataclass(frozen=True)
class Exercise:
    """A step's exercise: a package is built and run in every trial, and the checks judge what was observed.

    Without a `package` what is handed in is answers.toml alone, and the simulator runs by itself.
    """

    id: str
    title: str
    package: str
    trials: tuple[TrialSpec, ...]
    """In the order of the file; there is at least one."""
    checks: tuple[CheckSpec, ...]
    hints: tuple[Hint, ...]
    folder: Path
    digest: str = ""
    """sha256 of exercise.toml: what the exercise asks for, and how it is judged."""
    unsolved: tuple[str, ...] = ()
    """The checks that the starting point must fail (for its author: `grader validate`); what needs them is skipped."""

    def trial(self, id_: str) -> TrialSpec:
        """The trial with this id. Raises KeyError where there is none."""
        return {trial.id: trial for trial in self.trials}[id_]


def course_folder() -> Path:
    """The folder course/: beside the package in a checkout, inside it in an installed wheel.

    Raises MachineError when neither is there.
    """
    package = Path(__file__).resolve().parents[1]
    for folder in (package.parent / "course", package / "course"):
        if any(folder.glob(f"*/{FILE_NAME}")):
            return folder
    message = "The lessons (the folder course/) are missing from this installation of the grader: install it again."
    raise MachineError(message)


def catalogue(course: Path | None = None) -> dict[str, Path]:
    """Every exercise of the course, id -> its exercise.toml, in the order of the lessons; nothing is parsed."""
    folder = course_folder() if course is None else course
    return {file.parent.name: file for file in sorted(folder.glob(f"*/{FILE_NAME}"))}
