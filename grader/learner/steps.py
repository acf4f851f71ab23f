"""The steps of the course: start a step, store a report, and show the progress."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING

from grader.checks.exercises import exercise_of_folder, find_exercise, title_of
from grader.common.standard_streams import has_signs
from grader.common.words import a_list, count
from grader.errors import GraderError, UsageError
from grader.exercise.model import catalogue
from grader.learner import progress, workspace

if TYPE_CHECKING:
    from rich.console import Console

    from grader.evidence.evidence import Evidence
    from grader.exercise.model import Exercise
    from grader.learner.workspace import Started
    from grader.report.report import Report


PART_ONE, PART_TWO = "Part one: topics", "Part two: beyond topics"
FIRST_OF_PART_TWO = "08"
_OTHER_SHELLS = ("csh", "elvish", "fish", "nu", "pwsh", "tcsh", "xonsh")
_ROOM_FOR_TITLES = 60
"""The minimum width of a terminal (columns) on which the status shows the titles of the steps."""


@dataclass(frozen=True)
class Begun:
    """A started step: the exercise, the changes in the workspace, and the path of the workspace."""

    exercise: Exercise
    started: Started
    root: Path


def start(step: str, folder: Path | None, *, student: str | None = None, fresh: bool = False) -> Begun:
    """Start a step in the workspace. "next" stands for the first later step that the learner has not passed.

    If the learner has passed all later steps, "next" is the step after the current one. For a new learner, "next" is
    the first step.

    Raises:
        UsageError: the step does not exist, `student` is empty, or a file is in the place of a folder of the step (or
            the reverse). Also if `step` is "next", and the learner has not passed the current step yet or there is no
            later step.
        MachineError: the workspace or the progress cannot be read or written, or the starting point of the step is
            missing.
    """
    root = progress.workspace_of(folder)
    exercise = _next(progress.load(root)) if step == "next" else find_exercise(step)
    if student is not None and not student.strip():
        message = "--student needs a name or a number."
        raise UsageError(message)

    # Store the student id before adding files, and the current step after adding all its files.
    known = progress.update(
        root, lambda before: replace(before, student=student.strip() if student else before.student)
    )
    started = workspace.start(exercise, root, known.student, fresh=fresh)
    progress.update(root, lambda before: before.at(exercise.id))
    return Begun(exercise, started, root)


def begin_message(begun: Begun) -> str:
    """Return the text that `start` prints: the added and unchanged files, the tasks, and the next commands."""
    started = begun.started
    lines = [f"{begun.exercise.id}: {begun.exercise.title}, in {started.folder}"]
    if started.kept:
        lines.append(f"Your earlier work was moved to {started.kept}.")
    new = [path for path in started.added if path not in started.earlier]
    if new:
        lines.append(f"Added {', '.join(new)}.")
    if started.earlier:
        these = "this file" if len(started.earlier) == 1 else "these files"
        lines.append(
            f"Also added, from earlier steps: {', '.join(started.earlier)}. "
            f"The tasks (TODO) in {these} are not part of this step."
        )
    if started.present:
        lines.append(f"Not changed: {', '.join(started.present)}.")
    for path, lacking in started.lacking.items():
        lines += [
            workspace.lacking_text(path, lacking),
            *(f"    {line}" for line in lacking),
        ]
    lines += [f"To do in {path}: {task}" for path, tasks in started.tasks.items() for task in tasks]
    lesson = begun.exercise.folder / "lesson.md"
    lines += [
        "",
        f"The lesson:           {lesson}",
        "Grade your work:      grader check",
        "Grade on every save:  grader watch",
        *_in_new_terminals(),
    ]
    if begun.root != progress.workspace_of(None):  # `grader check` has no option --workspace
        lines.append(f"In every terminal:    export ROS2_WORKSPACE={quote(str(begun.root))}")
    return "\n".join(lines)


def _in_new_terminals() -> list[str]:
    """Return the lines that tell the learner what to type in each new terminal."""
    source = f"source {quote(str(_setup_file()))}"
    if needs_bash():
        return ["In each new terminal: bash", f"In this bash:         {source}"]
    return [f"In each new terminal: {source}"]


def needs_bash() -> bool:
    """Return whether the user's shell cannot read the setup files of ROS 2 and of the course."""
    return Path(os.environ.get("SHELL", "")).name in _OTHER_SHELLS


def _setup_file() -> Path:
    """Return the file to source in a new terminal to make ROS 2 and `grader` available in the user's shell."""
    shell = "zsh" if Path(os.environ.get("SHELL", "")).name == "zsh" else "bash"
    return Path(sys.prefix, f"setup.{shell}")


def current(folder: Path | None, *, outline: bool = False) -> tuple[Exercise, Path] | None:
    """Return the current step and the folder with the learner's work, or None if there is no current step.

    For `outline`, see `load_exercise`.
    """
    root = progress.workspace_of(folder)
    name = progress.load(root).current
    if name is None or name not in catalogue():
        return None
    exercise = find_exercise(name, outline=outline)
    return exercise, workspace.work_folder(exercise, root)


def note(exercise: Exercise, submission: Path, report: Report, folder: Path | None = None) -> str:
    """Store a report in the learner's progress if a step was started and the submission is in the workspace.

    Return a message about the learner's progress or the next command, or an empty string.
    """
    root = progress.workspace_of(folder)
    begun = progress.load(root)
    if begun.current is None:
        return ""
    if not submission.resolve().is_relative_to(root):
        lesson_named_it = report.exit_code == 1 and exercise.id in begun.steps and exercise_of_folder(submission)
        own = workspace.work_folder(exercise, root)
        return f"To grade your own work in {own}, type: grader check {exercise.id[:2]}" if lesson_named_it else ""
    known = progress.update(root, lambda before: before.graded(exercise.id, report))
    if report.exit_code != 0:
        return ""
    if all(known.step(name).passed for name in catalogue()):
        last = "" if all(begun.step(name).passed for name in catalogue()) else "That was the last step. "
        return f"{last}You have passed all steps."
    part = next((title for title, names in parts().items() if exercise.id == names[-1]), "")
    lines = [f"That was the last step of {part.lower()}."] if part else []
    lines.append(_following(known))
    with suppress(UsageError):  # the repository for students has no solutions
        workspace.solution(exercise)
        command = f"grader solution {exercise.id[:2]}"
        lines.append(f'Our solution next to yours, and the answers to "To think about": {command}')
    return "\n".join(lines)


def _following(known: progress.Progress) -> str:
    """Return the line about what is left to do: the current step, the next step, or steps that were left out."""
    if known.current in catalogue() and not known.step(known.current).passed:
        return f"Your current step, {known.current}, has not passed yet."
    return "The next step: grader start next" if _waiting(known) else _open_steps(known)


def keep_picture(evidence: Evidence, report: Report, folder: Path | None = None) -> str:
    """Save an image of the turtle's path in the workspace if a step about driving has passed. Return a message.

    The message is empty if no image was saved. No error is raised if the image cannot be written.
    """
    from grader.checks.kinds import KINDS

    exercise = evidence.exercise
    if report.exit_code != 0 or not any(KINDS[check.kind].drives for check in exercise.checks):
        return ""
    from grader.report.picture import save_picture

    file = progress.workspace_of(folder) / "pictures" / f"{exercise.id}.png"
    try:
        file.parent.mkdir(exist_ok=True)
        save_picture(evidence, report, file)
    except (OSError, GraderError):
        return ""
    return f"Image of your turtle's path: {file}"


def parts() -> dict[str, list[str]]:
    """Return a mapping from the title of each part of the course to its steps. Parts without steps are omitted."""
    names = list(catalogue())
    found = {
        PART_ONE: [name for name in names if name < FIRST_OF_PART_TWO],
        PART_TWO: [name for name in names if name >= FIRST_OF_PART_TWO],
    }
    return {title: part for title, part in found.items() if part}


def print_status(folder: Path | None, console: Console) -> None:
    """Print all steps with their progress."""
    from rich.table import Table

    root = progress.workspace_of(folder)
    known = progress.load(root)
    table = Table(box=None, pad_edge=False)
    titled = console.width >= _ROOM_FOR_TITLES
    for heading in ("", "step", *([""] if titled else []), "points", "hints"):
        # The id of a step is what a learner types, so it is never cut.
        table.add_column(heading, min_width=max(map(len, catalogue())) if heading == "step" else None)
    begins = {part[0]: title for title, part in parts().items()}
    for name, file in catalogue().items():
        if name in begins:
            table.add_row("", begins[name], style="bold")
        step = known.step(name)
        done, current, other = "✓→·" if has_signs(console.encoding) else "+>-"
        sign = done if step.passed else (current if name == known.current else other)
        points = f"{step.points:g}/{step.max:g}" if step.max else ""
        style = "green" if step.passed else ("bold" if name == known.current else "dim")
        title = [title_of(file)] if titled else []
        table.add_row(sign, name, *title, points, str(len(step.read) or ""), style=style)
    console.print(table)
    passed = sum(known.step(name).passed for name in catalogue())
    console.print(f"\n{passed} of {count(len(catalogue()), 'step')} passed, in {root}", soft_wrap=True)
    if known.current is None:
        console.print("Begin with: grader start 01")
    elif passed == len(catalogue()):
        console.print("You have finished the course.")
    elif known.step(known.current).passed:
        console.print("Continue with: grader start next" if _waiting(known) else _open_steps(known), soft_wrap=True)


def _next(known: progress.Progress) -> Exercise:
    if known.current is None or known.current not in catalogue():
        return find_exercise(next(iter(catalogue())))
    if not known.step(known.current).passed:
        message = (
            f"You have not passed {known.current} yet: `grader check` shows what is missing, and `grader hint` helps. "
            f"To skip this step for now, name another step, as in `grader start {_after(known.current)[:2]}`."
        )
        raise UsageError(message)
    waiting = _waiting(known)
    if not waiting:
        raise UsageError(_open_steps(known))
    return find_exercise(waiting[0])


def _after(name: str) -> str:
    """Return the step after the step `name`, or the first step of the course after the last one."""
    names = list(catalogue())
    return names[(names.index(name) + 1) % len(names)]


def _waiting(known: progress.Progress) -> list[str]:
    """Return the later steps that the learner has not passed yet, or all later steps if all are passed.

    If the course does not contain the current step, the later steps are all steps.
    """
    names = list(catalogue())
    later = names[names.index(known.current) + 1 :] if known.current in names else names
    return [name for name in later if not known.step(name).passed] or later


def _open_steps(known: progress.Progress) -> str:
    """Return the message for a learner at the last step: which steps are not passed yet, or that none is left."""
    missing = [name for name in catalogue() if not known.step(name).passed]
    if not missing:
        return f"{known.current} was the last step. You have finished the course. `grader status` shows all steps."
    names = a_list([name[:2] for name in missing])
    return f"Not passed yet: {names}. Go on with `grader start {missing[0][:2]}`."
