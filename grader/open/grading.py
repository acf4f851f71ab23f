"""Grade the current step after each save, and show the verdict on the page."""

from __future__ import annotations

from contextlib import closing
from typing import TYPE_CHECKING

from grader.errors import GraderError, MachineError
from grader.grading.options import Options
from grader.learner import steps
from grader.learner.watch import Watched
from grader.learner.workspace import lacking_lines, lacking_text, open_tasks
from grader.open.verdict_html import verdict_html
from grader.sandbox import bubblewrap

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from grader.exercise.model import Exercise
    from grader.learner.watch import Events
    from grader.open.desk import Desk

RERUN, STEP = "rerun", "step"
"""The commands from the process of the page: grade again, or check whether the current step has changed."""


def run(desk: Desk, events: Events, workspace: Path | None) -> None:
    """Grade the current step, and grade it again after a change or on request, until there are no more events."""
    options = Options(in_cell=bubblewrap.usable())
    current = steps.current(workspace)
    while True:
        desk.begin(*(current or (None, None)))
        if current is None:
            if not _await_step(events):
                return
        else:
            exercise, folder = current
            events.watch(folder)
            with closing(Watched(exercise, folder, options)) as watched:
                if not _grade_until_another(desk, events, watched, workspace):
                    return
        current = steps.current(workspace)


def _await_step(events: Events) -> bool:
    """Wait for a command after which the current step may have changed. Return False when there are no more events."""
    return any(happened.key == STEP for happened in events)


def _grade_until_another(desk: Desk, events: Events, watched: Watched, workspace: Path | None) -> bool:
    """Grade a step until the learner starts another step. Return False when there are no more events."""
    for happened in events:
        if happened.key == STEP:
            current = steps.current(workspace)
            if current is None or (current[0].id, current[1]) != (watched.exercise.id, watched.folder):
                return True
        elif happened.key == RERUN or (happened.kind == "saved" and watched.changed()):
            _grade(desk, watched, workspace)
        _prove(desk, events, watched)
    return False


def _grade(desk: Desk, watched: Watched, workspace: Path | None) -> None:
    desk.tell("Reading")
    try:
        graded = watched.grade(
            desk.tell, desk.early, lambda opened: desk.read(opened.digest, lacking(watched.exercise, opened.files))
        )
        # Store the progress before the verdict is shown, even on a slow disk, because the button for the next step
        # needs the stored progress.
        steps.note(watched.exercise, watched.folder, graded.report, workspace)
        desk.judged(graded.report)
        desk.detailed(verdict_html(graded.evidence, graded.report, watched.folder))
    except GraderError as error:
        desk.failed(str(error))
    watched.prepare()


def lacking(exercise: Exercise, files: Mapping[str, bytes]) -> list[dict[str, object]]:
    """Return the lines and the tasks (TODO) of the step that are missing from the learner's package files.

    Return an empty list if the files of the step cannot be read.
    """
    try:
        lines, tasks = lacking_lines(exercise, files), open_tasks(exercise, files)
    except (OSError, MachineError):
        return []
    to_add: list[dict[str, object]] = [
        {"file": path, "lines": list(each), "text": lacking_text(path, each)} for path, each in lines.items()
    ]
    to_do: list[dict[str, object]] = [
        {"file": path, "lines": [], "text": f"To do in {path}: {each}"} for path in tasks for each in tasks[path]
    ]
    return [*to_add, *to_do]


def _prove(desk: Desk, events: Events, watched: Watched) -> None:
    """Test whether a fix for a cause in the verdict helps, and show the results. Stop when an event is pending."""
    proved = watched.prove(desk.tell, events.waiting)
    if proved is not None:
        desk.judged(proved.report)
        desk.detailed(verdict_html(proved.evidence, proved.report, watched.folder))
    else:
        desk.tell("")
