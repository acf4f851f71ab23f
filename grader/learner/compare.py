"""Show the solution of a step next to the learner's files."""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

from grader.checks.exercises import find_exercise
from grader.common.words import printable
from grader.errors import UsageError
from grader.exercise.markers import MEANT, solved, syntax_of
from grader.exercise.model import catalogue
from grader.learner import progress, workspace
from grader.learner.exercise_argument import existing_work
from grader.learner.in_words import difference
from grader.submission import tree
from grader.submission.reader import read

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from rich.console import Console

    from grader.exercise.model import Exercise

WIDE = 120
"""The number of columns that a terminal needs to show both files side by side.

On a narrower terminal and in a pipe, a unified diff is shown.
"""

OTHER_NUMBERS = "The solution has the numbers of an example student. Keep your own numbers in your files."


def print_solution(step: str, folder: Path | None, console: Console) -> None:
    """Print the differences from the solution, and the answers to the questions under "To think about".

    Raises:
        UsageError: there is no such step, the learner has not passed it yet, the learner's folder does not exist or
            cannot be read, or this copy of the course has no solutions.
        MachineError: the learner's progress cannot be read.
    """
    exercise = find_exercise(step)
    root = progress.workspace_of(folder)
    if not progress.load(root).step(exercise.id).passed:
        message = (
            f"You can see the solution of {exercise.id} after your own solution has passed. Until then, `grader hint "
            f"{exercise.id}` helps."
        )
        raise UsageError(message)
    ideal = workspace.solution(exercise)
    # Later steps change the rest of the package, so compare only files that the learner had to write.
    asked = _asked(exercise)
    texts = _texts(ideal / exercise.package if exercise.package else ideal, marked=True)
    ours = {path: text for path, text in texts.items() if path in asked}
    theirs = _texts(existing_work(exercise, root), marked=False)
    same = [path for path in ours if theirs.get(path) == ours[path]]
    if exercise.numbers is not None and len(same) < len(ours):
        console.print(OTHER_NUMBERS, soft_wrap=True, markup=False)
    for path in ours:
        if path not in same:
            _print_file(path, theirs.get(path, ""), ours[path], console)
    if same:
        console.print(f"Identical to the solution: {', '.join(same)}", soft_wrap=True, markup=False)
    thoughts = exercise.folder / "afterwards.md"
    if thoughts.is_file():
        text = thoughts.read_text(encoding="utf-8").removeprefix("# ").rstrip()
        console.print("\n" + text.replace("\n   ", " "), markup=False)  # the console wraps lines


def _asked(exercise: Exercise) -> set[str]:
    """Return the files with marked regions in this step, except files with the same content in an earlier step."""
    ours = _solution_files(exercise)
    marked = [path for path in ours if syntax_of(path) and MEANT.search(ours[path].decode("utf-8", "ignore"))]
    earlier = [_solution_files(find_exercise(id_)) for id_ in catalogue() if id_ < exercise.id]
    return {path for path in marked if all(files.get(path) != ours[path] for files in earlier)}


def _solution_files(exercise: Exercise) -> Mapping[str, bytes]:
    folder = workspace.solution(exercise)
    return read(tree.read_folder, folder / exercise.package if exercise.package else folder).files


def _texts(folder: Path, *, marked: bool) -> dict[str, str]:
    """Return the text of each UTF-8 file by path. With `marked`, the markers of the solution are left out."""
    files = read(tree.read_folder, folder).files
    texts = {}
    for path in sorted(files, key=tree.sort_key):
        try:
            text = files[path].decode("utf-8").replace("\r\n", "\n")
        except UnicodeDecodeError:
            continue
        syntax = syntax_of(path)
        texts[path] = solved(text, syntax, path) if marked and syntax else text
    return texts


def _print_file(path: str, theirs: str, ours: str, console: Console) -> None:
    from rich.text import Text

    console.print(Text(f"\n{path}", style="bold"))
    console.print(Text(printable(read(difference, theirs, ours, path))), soft_wrap=True)
    if console.is_terminal and console.width >= WIDE:
        _print_beside(theirs, ours, console)
        return
    lines = difflib.unified_diff(theirs.splitlines(), ours.splitlines(), "yours", "the solution", lineterm="")
    styles = {"+": "green", "-": "red", "@": "cyan"}
    for line in lines:
        console.print(Text(printable(line.expandtabs(4)), style=styles.get(line[:1], "")), soft_wrap=True)


def _print_beside(theirs: str, ours: str, console: Console) -> None:
    from rich.syntax import Syntax
    from rich.table import Table

    table = Table(expand=True)
    table.add_column("yours", ratio=1)
    table.add_column("the solution", ratio=1)
    table.add_row(*(Syntax(_shown(text), "python", word_wrap=True) for text in (theirs, ours)))
    console.print(table)


def _shown(text: str) -> str:
    return "\n".join(printable(line.expandtabs(4)) for line in text.splitlines())
