"""The settings for course/nbgrader_config.py: the folders of the course, and the grader's additional steps."""

from __future__ import annotations

import logging
import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

from grader.common.terminal_text import without_control
from grader.gradebook.class_folders import CLASS, GRADEBOOK, ID

COURSE_ID = "ros2-topics"
"""The course's name in nbgrader's exchange, unless `grader class new` has written another name."""
BUSY_S = 60
"""The maximum time that nbgrader waits for a locked database (s)."""


def configure(config: Any, root: Path) -> None:  # noqa: ANN401 - traitlets' Config, whose sections appear when named
    """Configure nbgrader for the course in `root`, the folder that contains solutions/ and exercises/."""
    from nbgrader import preprocessors as steps

    from grader.gradebook import converters, formgrader_times
    from grader.gradebook.confined_autograde import CHECK_S, ConfinedExecute
    from grader.gradebook.exchange import BoundedList, BoundedReleaseFeedback
    from grader.gradebook.export import ConfirmedCsv
    from grader.gradebook.feedback import GraderReasons, HideHiddenTests
    from grader.gradebook.pages import configure_pages
    from grader.gradebook.release_preprocessors import ReleaseFiles, StripSolutions
    from grader.gradebook.restore import RestoreCells
    from grader.gradebook.unconfirmed import SaveUnconfirmed

    _see_own_commands()
    _log_no_control_characters()
    converters.install()
    formgrader_times.install()
    folders = config.CourseDirectory
    folders.root = str(root)
    folders.course_id = _course_id(root / CLASS / ID)
    folders.source_directory = "solutions"
    folders.release_directory = "exercises"
    folders.submitted_directory = f"{CLASS}/submitted"
    folders.autograded_directory = f"{CLASS}/autograded"
    folders.feedback_directory = f"{CLASS}/feedback"
    folders.solution_directory = f"{CLASS}/solution"
    folders.source_with_tests_directory = f"{CLASS}/source_with_tests"
    (root / CLASS).mkdir(mode=0o700, exist_ok=True)  # other users of the machine must not read the gradebook
    folders.db_url = f"sqlite:///{root / CLASS / GRADEBOOK}?timeout={BUSY_S}"

    # exercises/ already exists in git. Let nbgrader create the folder again.
    config.GenerateAssignment.force = True
    config.GenerateAssignment.preprocessors = [
        steps.LockCells,
        StripSolutions,
        steps.ClearOutput,
        steps.CheckCellMetadata,
        steps.ComputeChecksums,
        steps.SaveCells,
        steps.ClearHiddenTests,
        steps.ComputeChecksums,
        steps.CheckCellMetadata,
        ReleaseFiles,
    ]
    # By default, `nbgrader validate` limits each cell to 30 s, which is too short for four trials.
    config.Execute.timeout = CHECK_S
    config.Autograde.exporter_class = converters.BoundedNotebook
    config.GenerateFeedback.exporter_class = converters.BoundedPage
    config.ExchangeFactory.collect = converters.BoundedCollect
    config.ExchangeFactory.release_feedback = BoundedReleaseFeedback
    config.ExchangeFactory.list = BoundedList
    configure_pages(config)
    config.Autograde.sanitize_preprocessors = [
        steps.ClearOutput,
        RestoreCells,
        steps.DeduplicateIds,
        steps.OverwriteKernelspec,
        steps.OverwriteCells,
        steps.CheckCellMetadata,
    ]
    config.Autograde.autograde_preprocessors = [
        ConfinedExecute,
        steps.IgnorePattern,
        "nbconvert.preprocessors.ClearMetadataPreprocessor",
        steps.LimitOutput,
        SaveUnconfirmed,
        steps.AssignLatePenalties,
        steps.CheckCellMetadata,
    ]
    # Grade the students' files unchanged, and do not replace missing files with those of the solution.
    config.Autograde.exclude_overwriting = {
        step.name: [path for path in _files(step) if not path.endswith(".ipynb")]
        for step in sorted((root / "solutions").glob("*"))
        if step.is_dir()
    }
    config.GenerateFeedback.preprocessors = [
        steps.GetGrades,
        HideHiddenTests,
        GraderReasons,
        "nbconvert.preprocessors.CSSHTMLHeaderPreprocessor",
    ]
    config.ExportApp.plugin_class = ConfirmedCsv


def _course_id(file: Path) -> str:
    try:
        return file.read_text("utf-8").strip() or COURSE_ID
    except FileNotFoundError:
        return COURSE_ID


def _see_own_commands() -> None:
    """Add this Python's scripts to PATH, because nbgrader runs alembic to create its database."""
    path, ours = os.environ.get("PATH", os.defpath), str(Path(sys.prefix, "bin"))
    if ours not in path.split(os.pathsep):
        os.environ["PATH"] = f"{path}{os.pathsep}{ours}"


def _log_no_control_characters() -> None:
    """Replace control characters in all log messages, since nbgrader logs names that students have chosen."""
    logging.setLogRecordFactory(_without_control_characters)


def _without_control_characters(*about: Any, **more: Any) -> logging.LogRecord:  # noqa: ANN401 - as in logging
    record = logging.LogRecord(*about, **more)
    with suppress(Exception):  # logging itself reports a message with a wrong format
        record.msg, record.args = without_control(record.getMessage()), None
    return record


def _files(step: Path) -> list[str]:
    return [str(file.relative_to(step)) for file in sorted(step.rglob("*")) if file.is_file()]
