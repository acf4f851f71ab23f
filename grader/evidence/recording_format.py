"""Recording: a graded submission as a folder that contains everything needed to judge it again, without running it.

    trials/ID/       one folder per trial: bag/ with the messages (rosbag2, MCAP) and trial.json with the rest;
                     calls.json instead, if functions or programs were called without a simulator; or tests.json
                     instead, if the student's tests were run
    build.json       the result of the build
    tries.json       the fixes that were tested, with their results; only for instructors, since it shows solutions
    submission.json  name, student, digest and paths, the version of ROS 2, whether the code ran in a sandbox, and what
                     could not be read or run
    source/          the files of the submission
    exercise/        the exercise at that time: exercise.toml
    COLCON_IGNORE    so that colcon never runs the submission's setup.py

trials/ID/ is missing if that trial was not completed, build.json if nothing was built, and tries.json if no fix was
tested.
"""

from __future__ import annotations

import json
import os
import shutil
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from grader.colcon.build import Build
from grader.common.json_types import text, text_or_none, whole_or_none
from grader.errors import MachineError, UsageError
from grader.evidence.evidence import Evidence, Fault, Run
from grader.evidence.stage import STAGES
from grader.evidence.tries import Tries, Try
from grader.exercise.model import FILE_NAME
from grader.submission.package import Submission, open_answers, open_submission, write_copy
from grader.submission.search import IGNORE_MARKER
from grader.testbench.result import from_json as tests_from_json
from grader.trial.called import called_from_json
from grader.trial.recording_json import from_json, to_json

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from grader.evidence.stage import Stage
    from grader.exercise.model import Exercise
    from grader.testbench.result import BenchResult
    from grader.trial.called import Called
    from grader.trial.recording import Recording

_SCHEMA = 2


@dataclass(frozen=True)
class Archived:
    """The evidence that was read from an archive, and the name of the ROS 2 installation for the report."""

    evidence: Evidence
    ros: str
    confined: bool | None
    """Whether the code ran in a sandbox, or None if the archive does not say so: it is from an earlier version."""


def save(folder: Path, evidence: Evidence, ros: str, prefixes: Iterable[Path], *, confined: bool | None = True) -> None:
    """Write the evidence to a folder, which must be new or empty. `prefixes` are the folders with the .msg files.

    `confined` is whether the code ran in a sandbox, as in the report.

    Raises:
        UsageError: the path is a file, or a folder that is not empty.
        MachineError: the folder cannot be written.
    """
    check_free(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        # Without this file, running colcon in a parent folder would run the submission's setup.py outside the sandbox.
        (folder / IGNORE_MARKER).touch()
        submission = evidence.submission
        write_copy(submission, folder / "source" / submission.package_dir.name)
        (folder / "exercise").mkdir()
        shutil.copyfile(evidence.exercise.folder / FILE_NAME, folder / "exercise" / FILE_NAME)
        _write(folder / "submission.json", _about(evidence, ros, confined))
        if evidence.build is not None:
            _write(folder / "build.json", {"schema": _SCHEMA, **asdict(evidence.build)})
        if evidence.tries != Tries():
            _write(folder / "tries.json", {"schema": _SCHEMA, **asdict(evidence.tries)})
        for trial, run in evidence.runs.items():
            if run.recording is not None:
                _save_recording(folder / "trials" / trial, run.recording, prefixes)
            if run.called is not None:
                (folder / "trials" / trial).mkdir(parents=True)
                calls = {"schema": _SCHEMA, "calls": [asdict(each) for each in run.called]}
                _write(folder / "trials" / trial / "calls.json", calls)
            if run.bench is not None:
                (folder / "trials" / trial).mkdir(parents=True)
                _write(folder / "trials" / trial / "tests.json", {"schema": _SCHEMA, **asdict(run.bench)})
    except OSError as error:
        message = f"The recording could not be written to {folder}: {error.strerror}."
        raise MachineError(message) from error


def _save_recording(folder: Path, recording: Recording, prefixes: Iterable[Path]) -> None:
    from grader.evidence.bag import write_bag  # importing rosbags is slow, so import it only when needed

    folder.mkdir(parents=True)
    write_bag(folder / "bag", recording.messages, prefixes)
    _write(folder / "trial.json", {"schema": _SCHEMA, **to_json(recording, messages=False)})


def _load_recording(folder: Path) -> Recording | None:
    if not (folder / "trial.json").exists():
        return None
    from grader.evidence.bag import read_payloads

    recording = from_json(_read(folder / "trial.json"), read_payloads(folder / "bag"))
    text(recording.clock)
    text(recording.why)
    whole_or_none(recording.seed)
    return recording


def _load_calls(folder: Path) -> tuple[Called, ...] | None:
    if not (folder / "calls.json").exists():
        return None
    return tuple(called_from_json(each) for each in _read(folder / "calls.json")["calls"])


def _load_tests(file: Path) -> BenchResult | None:
    return tests_from_json(_read(file)) if file.exists() else None


def check_free(folder: Path) -> None:
    """Check, before a trial is run, that a recording can be written to this folder.

    Raises:
        UsageError: the path is a file, a folder that is not empty, or a path that the user may not write.
    """
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        message = f"{folder} is not an empty folder. Choose a new folder for the recording."
        raise UsageError(message)
    there = next(path for path in (folder.absolute(), *folder.absolute().parents) if os.path.lexists(path))
    if not there.is_dir() or not os.access(there, os.W_OK | os.X_OK):
        message = f"The recording cannot be written to {folder}: {there} is not a folder that you can write to."
        raise UsageError(message)


def load(folder: Path, read_exercise: Callable[[Path], Exercise]) -> Archived:
    """Read an archive.

    `read_exercise` is called with the path of the archive's exercise.toml, and returns the exercise with its checks.

    Raises:
        UsageError: the folder is not an archive that this version of the grader can read.
    """
    if not os.path.lexists(folder / "submission.json"):
        why = "is not a recording: it has no submission.json" if folder.is_dir() else "is not a folder"
        message = f"{folder} {why}. Give the folder that `grader check --recording` wrote."
        raise UsageError(message)
    try:
        about = _read(folder / "submission.json")
        kept = read_exercise(folder / "exercise" / FILE_NAME)
        package = folder / "source" / Path(text(about["package"])).name  # only inside the archive
        opened = open_submission(package) if kept.package else open_answers(package)
        submission = Submission(
            name=text(about["name"]),
            package_dir=opened.package_dir,
            files=opened.files,
            rejected=tuple(map(text, about["rejected"])),
            digest=text(about["digest"]),
            executable=opened.executable,
            student=text_or_none(about.get("student")),
        )
        ros, confined = text(about["ros"]), _true_or_false(about.get("confined"))
        build = _build(_read(folder / "build.json")) if (folder / "build.json").exists() else None
        fault = _fault(**about["fault"]) if about["fault"] else None
        tries = _tries(_read(folder / "tries.json")) if (folder / "tries.json").exists() else Tries()
        runs = {
            trial.id: Run(
                _load_recording(folder / "trials" / trial.id),
                text_or_none(about["runs"][trial.id]["overwhelmed"]),
                _load_calls(folder / "trials" / trial.id),
                _load_tests(folder / "trials" / trial.id / "tests.json"),
            )
            for trial in kept.trials
            if trial.id in about["runs"]
        }
    except (OSError, KeyError, TypeError, ValueError, AttributeError) as error:
        why = f"{type(error).__name__}: {error}"
        message = (
            f"{folder} is not a recording from `grader check --recording`, or it is damaged or from another version of "
            f"the grader ({why})."
        )
        raise UsageError(message) from error
    return Archived(Evidence(kept, submission, build, runs, fault, tries), ros, confined)


def _about(evidence: Evidence, ros: str, confined: bool | None) -> dict[str, Any]:
    submission = evidence.submission
    return {
        "schema": _SCHEMA,
        "name": submission.name,
        "package": submission.package_dir.name,
        "digest": submission.digest,
        "rejected": list(submission.rejected),
        "student": submission.student,
        "files": [os.fsencode(path).decode("utf-8", "backslashreplace") for path in submission.files],
        "ros": ros,
        "confined": confined,
        "fault": asdict(evidence.fault) if evidence.fault else None,
        "runs": {trial: {"overwhelmed": run.overwhelmed} for trial, run in evidence.runs.items()},
    }


def _true_or_false(value: object) -> bool | None:
    if value is not None and not isinstance(value, bool):
        problem = f"{value!r:.40} is neither true nor false"
        raise ValueError(problem)
    return value


def _fault(stage: Stage, message: object, *, unreadable: bool) -> Fault:
    if stage not in STAGES:
        problem = f"there is no stage {stage!r:.40}"
        raise ValueError(problem)
    return Fault(stage, text(message), bool(unreadable))


def _build(data: dict[str, Any]) -> Build:
    lists = {name: tuple(data[name]) for name in ("installed", "executables")}
    return Build(**{**data, **lists})


def _tries(data: dict[str, Any]) -> Tries:
    return Tries(**{**data, "made": tuple(Try(**each) for each in data["made"])})


def _write(file: Path, data: dict[str, Any]) -> None:
    # Escape names that are not valid UTF-8, so that every program can read the JSON.
    file.write_text(json.dumps(data, indent=1, ensure_ascii=True) + "\n", encoding="ascii")


def _read(file: Path) -> dict[str, Any]:
    data = json.loads(file.read_text(encoding="utf-8"))
    if not isinstance(data, dict) or data.pop("schema", None) != _SCHEMA:
        message = f"{file.name} does not have schema {_SCHEMA}"
        raise ValueError(message)
    return data
