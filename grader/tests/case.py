"""Cases: submissions as learners write them, and the expected reports of `grader check`.

Each case is a folder:

    grader/tests/cases/NNN-name/
      files/           copied over the base; without a base, the whole submission
      make.py          make(folder): creates files that git cannot store (links, names that are not UTF-8, ...)
      expected.toml    the keys are the fields of `Case`, below, except `name` and `folder`
"""

from __future__ import annotations

import importlib.util
import shutil
import sys
from dataclasses import dataclass, fields
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from packaging.specifiers import SpecifierSet

from grader.exercise.markers import solved, syntax_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).parent.parent.parent
CASES = Path(__file__).parent / "cases"
BASES = Path(__file__).parent / "bases"
"""Packages as learners write them. Several cases change these packages in a few places."""
EXERCISE_OF_BASES = "03-circle-publisher"
"""The exercise of the packages in bases/, and of cases without a base."""
EXIT_CODES = {"passed": 0, "failed": 1, "usage": 2, "error": 3}


@dataclass(frozen=True)
class Case:
    """The content of expected.toml. A check is named by its id. A check that is not named must pass."""

    name: str
    why: str
    """How the submission differs from a usual submission, for readers of the tests."""
    result: str
    """One of the keys of EXIT_CODES."""
    folder: Path = CASES
    """The folder of the case. `folder` is not a key of expected.toml."""
    base: str = "03-circle-publisher"
    """The base is the solution of a step or a package in bases/, and `files` is copied over it. Empty for a case
    without a base."""
    exercise: str = ""
    """The exercise that grades the case. If this is empty and `base` is the solution of a step, that step's exercise
    grades the case."""
    edit: tuple[Mapping[str, str], ...] = ()
    """The edits of the base: `old` in `file` is replaced with `new` everywhere."""
    remove: tuple[str, ...] = ()
    """The paths of the base that are removed."""
    give: str = "."
    """The path of the submission, relative to the folder that contains the package."""
    sample: bool = False
    """Whether the case belongs to the sample that `make test` runs."""
    clock: str = ""
    """The clock that `--clock auto` must choose; empty for any clock."""
    wall_varies: str = ""
    """The reason why two runs in wall time can have different results. If there is such a reason, the results with the
    two clocks are not compared. Usually empty."""
    rclpy: str = ""
    """The versions of rclpy with which a node behaves in this way, as in "<7.1.9"; empty for all versions. The case is
    not run with another version."""
    points: float | None = None
    failed: tuple[str, ...] = ()
    skipped: tuple[str, ...] = ()
    advice: tuple[str, ...] = ()
    """The expected advice: the checks worth 0 points that did not pass. These checks are not listed in `failed`."""
    diagnosis: Mapping[str, str] = ()  # type: ignore[assignment]
    """Maps a check to the stable id of its expected cause."""
    where: Mapping[str, str] = ()  # type: ignore[assignment]
    """Maps a check to the place, as in "file:line"."""
    says: Mapping[str, tuple[str, ...]] = ()  # type: ignore[assignment]
    """Maps a check to strings that its message must contain. The key "usage" is for the message of exit code 2."""
    never: tuple[str, ...] = ()
    """Text that the report must not contain."""

    @property
    def is_of_this_rclpy(self) -> bool:
        """Whether the installed version of rclpy is one for which the case is meant."""
        return not self.rclpy or SpecifierSet(self.rclpy).contains(version("rclpy"))


def read_case(folder: Path) -> Case:
    """Return the case in a folder. Raises ValueError for an unknown key."""
    values: dict[str, Any] = tomllib.loads((folder / "expected.toml").read_text("utf-8"))
    unknown = values.keys() - ({field.name for field in fields(Case)} - {"name", "folder"})
    if unknown or values["result"] not in EXIT_CODES:
        message = f"{folder.name}/expected.toml: {unknown or values['result']}"
        raise ValueError(message)
    for key in ("edit", "remove", "failed", "skipped", "advice", "never"):
        values[key] = tuple(values.get(key, ()))
    for key in ("diagnosis", "where", "says"):
        values[key] = values.get(key, {})
    return Case(name=folder.name, folder=folder, **values)


def read_cases(below: Path = CASES) -> tuple[Case, ...]:
    """Return every case of a folder, sorted by name."""
    return tuple(read_case(folder) for folder in sorted(below.iterdir()) if (folder / "expected.toml").is_file())


def base_of(case: Case) -> Path | None:
    """Return the folder of the package that the case starts from, or None."""
    if not case.base:
        return None
    return BASES / case.base if (BASES / case.base).is_dir() else ROOT / "solutions" / case.base


def exercise_of(case: Case) -> str:
    """Return the id of the exercise that grades the case."""
    return case.exercise or (EXERCISE_OF_BASES if (BASES / case.base).is_dir() else case.base)


def make_submission(case: Case, to: Path) -> Path:
    """Write the submission below the new folder `to`, and return its path."""
    to.mkdir(parents=True)
    base = base_of(case)
    package = to / "my_robot_controller" if base is not None and (base / "my_robot_controller").is_dir() else to
    if base is not None and base.parent == BASES:
        shutil.copytree(base, to, dirs_exist_ok=True, ignore=shutil.ignore_patterns("__pycache__"))
    elif base is not None:
        copy_solution(case.base, package)
    apply_edits(case.edit, package, case.name)
    for path in case.remove:
        target = package / path
        if target.is_dir():
            shutil.rmtree(target)
        else:
            target.unlink()
    files = case.folder / "files"
    if files.is_dir():
        shutil.copytree(files, package, dirs_exist_ok=True)
    generator = case.folder / "make.py"
    if generator.is_file():
        spec = importlib.util.spec_from_file_location("make", generator)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        module.make(to)
    return to / case.give


def apply_edits(edits: Iterable[Mapping[str, str]], package: Path, name: str) -> None:
    """In each `file` of a package, replace `old` with `new` everywhere. Raises AssertionError if `old` is not found."""
    for edit in edits:
        file = package / edit["file"]
        text = file.read_text("utf-8")
        assert edit["old"] in text, f"{name}: {edit}"
        file.write_text(text.replace(edit["old"], edit["new"]), "utf-8")


def copy_solution(step: str, to: Path) -> None:
    """Copy a solution's package (in step 02, the answers) without the markers, as a learner would have written it."""
    source = ROOT / "solutions" / step
    source = source / "my_robot_controller" if (source / "my_robot_controller").is_dir() else source
    for file in sorted(path for path in source.rglob("*") if path.is_file() and "__pycache__" not in path.parts):
        target = to / file.relative_to(source)
        target.parent.mkdir(parents=True, exist_ok=True)
        syntax = syntax_of(file.name)
        if syntax is None:
            shutil.copy(file, target)
        else:
            target.write_text(solved(file.read_text("utf-8"), syntax, str(file)), "utf-8")
