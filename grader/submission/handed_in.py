"""Read a submission together with the files that only its notebook contains.

A student may write a node in a cell and never run the cell, or hand in only the notebook. In these cases, the text of
the cell counts if the file is missing from the package or unchanged from the starting point. No cell is run.
"""

from __future__ import annotations

import json
import os
import stat
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common.words import a_list
from grader.errors import UnreadableError, UsageError
from grader.exercise.model import catalogue
from grader.exercise.starting_point import starting_point
from grader.submission import tree
from grader.submission.notebook_cells import Part, counts, ended, parts_of, starting_text
from grader.submission.package import ANSWERS, Submission, digest, open_answers, open_submission
from grader.submission.reader import read
from grader.submission.search import NoPackageError
from grader.submission.tree import shown

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.exercise.model import Exercise

ENDING = ".ipynb"
MOST_NOTEBOOKS = 20
"""The maximum number of notebooks that are read in one folder."""
MOST_NESTED = 4
"""A notebook without a package may be inside up to this many nested folders, if each contains only the next one."""
MOST_NAME = 255
"""The maximum length of the name of a file (bytes)."""


def open_handed_in(path: str | os.PathLike[str], exercise: Exercise, *, exactly: bool = False) -> Submission:
    """Read the package below this folder, or its answers.toml, and add the files that only the notebook contains.

    `exactly` has the same meaning as in `open_submission`, which raises the same exceptions.
    """
    name = os.fspath(path)
    try:
        return read(_handed_in, name, Path(name), exercise, exactly)
    except UnreadableError as error:
        if str(error).startswith(shown(name)):
            raise
        message = f"{shown(name)} cannot be opened: {error}."
        raise type(error)(message) from error


def _handed_in(name: str, path: Path, exercise: Exercise, exactly: bool) -> Submission:
    missing: UsageError | None = None
    found = None
    try:
        if exercise.package:
            found = open_submission(name, exercise.package, exactly=exactly)
        else:
            found = open_answers(name, exactly=exactly)
    except NoPackageError as error:
        missing = error
    root = path if exactly else path.resolve()
    if found is None:
        folder = _only_folder(root)
        parts, remark = _chosen(exercise, folder)
    else:
        parts, remark = _beside(exercise, root, found.package_dir.relative_to(path.resolve()))
    if found is None:
        start = _started(exercise, folder) if parts else None
        if missing is not None and start is None:
            why = remark or _why_no_cell_counts(exercise, folder)
            message = f"{missing} {why}".rstrip()
            raise NoPackageError(message)
        found = Submission(name, path.resolve() / folder.relative_to(root) / exercise.package, start or {}, (), "")
    if found.rejected:
        return found  # an invalid package is judged as it is
    return replace(_with(exercise, found, parts), remark=remark)


def _beside(exercise: Exercise, root: Path, package: Path) -> tuple[list[Part], str]:
    """Return the first result of `_chosen` that is not empty, or an empty result.

    `_chosen` is called for the folders that contain the package, from the innermost to `root`, then for the package.
    """
    for folder in (*(root / each for each in package.parents), root / package):
        parts, remark = _chosen(exercise, folder)
        if parts or remark:
            return parts, remark
    return [], ""


def _only_folder(folder: Path) -> Path:
    """Return the folder in which a notebook without a package may be.

    A folder that contains only one other folder is skipped. At most MOST_NESTED folders are skipped.
    """
    for _ in range(MOST_NESTED):
        with tree.open_folder(os.fspath(folder)) as opened:
            listing = [each for each in tree.entries(opened) or [] if not each.name.startswith((".", "__"))]
        if len(listing) != 1 or not listing[0].is_folder:
            break
        folder = folder / listing[0].name
    return folder


def _started(exercise: Exercise, folder: Path) -> dict[str, bytes]:
    """Return the starting point's files and the student's files, which replace starting files with the same path."""
    name = exercise.package or "."
    files: dict[str, bytes] = {}
    for source in (starting_point(exercise), folder):
        try:
            found = tree.read_folder(source / name, follow=False).files
        except OSError:
            continue  # the student handed in no file of the package
        files |= found if exercise.package else {each: found[each] for each in (ANSWERS,) if each in found}
    return files


def _chosen(exercise: Exercise, folder: Path) -> tuple[list[Part], str]:
    """Return the files from the cells that count, and a remark about the notebooks whose cells do not count.

    The notebook with the name of the exercise comes first. Then come notebooks whose names begin with the name of the
    exercise: a browser adds "(1)" to the name of a second download. All others come last. Several notebooks that rank
    equally are used only if they write the same files. A notebook whose name begins with the name of another exercise
    is ignored.
    """
    groups: dict[int, dict[str, list[Part]]] = {}
    broken: list[str] = []
    others = tuple(each for each in catalogue() if each != exercise.id)
    for name, data in _notebooks(folder):
        if name.startswith(others):
            continue
        parts = _worked_on(exercise, data)
        rank = 0 if name == exercise.id + ENDING else 1 if name.startswith(exercise.id) else 2
        if parts:
            groups.setdefault(rank, {})[name] = parts
        elif parts is None and rank < 2:  # the notebook has the name of the exercise
            broken.append(name)
    ordered = [groups[rank] for rank in sorted(groups)]
    best = list(ordered[0].values()) if ordered else []
    counted = best[0] if best and all(each == best[0] for each in best) else []
    ignored = [name for group in ordered for name, parts in group.items() if parts != counted]
    remarks = []
    if ignored:
        names = a_list([shown(each) for each in ignored])
        remarks.append(f"The cells of {names} were not used, because there are several notebooks.")
    if broken:
        kind = "a notebook" if len(broken) == 1 else "notebooks"
        remarks.append(f"{a_list([shown(each) for each in broken])} could not be read as {kind}.")
    return counted, " ".join(remarks)


def _why_no_cell_counts(exercise: Exercise, folder: Path) -> str:
    """Return why the notebooks in a folder without a package do not replace it, or "" if there is no notebook."""
    names = [name for name, _ in _notebooks(folder)]
    others = {name: each for name in names for each in catalogue() if each != exercise.id and name.startswith(each)}
    own = [shown(name) for name in names if name not in others]
    if own:
        magics = "%%node or %%package" if exercise.package else "%%answers"
        return f"In {a_list(own)}, no cell that begins with {magics} differs from the starting point."
    return " ".join(f"{shown(name)} is the notebook of {each}, not of {exercise.id}." for name, each in others.items())


def _notebooks(folder: Path) -> Iterator[tuple[str, bytes]]:
    """Yield the names and contents of the notebooks in a folder, without links and hidden files.

    The content of a file that is too large or cannot be read is empty.
    """
    with tree.open_folder(os.fspath(folder)) as opened:
        tree.require_path(opened, folder)
        names = [each for each in tree.entries(opened) or [] if each.is_file and each.name.endswith(ENDING)]
        for entry in [each for each in names if not each.name.startswith(".")][:MOST_NOTEBOOKS]:
            flags = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC
            try:
                descriptor = os.open(entry.name, flags, dir_fd=opened)
            except OSError as error:
                tree.reason(error, entry.name)  # raises an error if the machine is at fault
                yield entry.name, b""
                continue
            with os.fdopen(descriptor, "rb") as file:
                regular = stat.S_ISREG(os.fstat(descriptor).st_mode) and entry.size <= tree.MAX_FILE_BYTES
                yield entry.name, file.read(tree.MAX_FILE_BYTES) if regular else b""


def _worked_on(exercise: Exercise, notebook: bytes) -> list[Part] | None:
    """Return the files that the cells write and that differ from the starting point, or None for a broken notebook."""
    try:
        cells = json.loads(notebook)["cells"]
        sources = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    except (ValueError, KeyError, TypeError, RecursionError):
        return None
    return [part for part in parts_of(sources, exercise) if part.text != _start(exercise, part.path)]


def _start(exercise: Exercise, path: str) -> str | None:
    text = starting_text(exercise, path)
    return None if text is None else ended(text)


def _with(exercise: Exercise, found: Submission, parts: list[Part]) -> Submission:
    """Return the submission, with the files from the cells that count."""
    prefix = f"{exercise.package}/" if exercise.package else ""
    added: dict[str, bytes] = {}
    for part in parts:
        path = part.path.removeprefix(prefix)
        data = found.files.get(path)
        text = None if data is None else data.decode("utf-8", "replace")
        if counts(text, _start(exercise, part.path)) == "cell":
            _require_possible(path, found.files.keys() | added.keys())
            added[path] = part.text.encode()
    if not added:
        return found
    files = {**found.files, **added}
    ordered = {path: files[path] for path in sorted(files, key=tree.sort_key)}
    return replace(found, files=ordered, digest=digest(ordered))


def _require_possible(path: str, others: set[str]) -> None:
    """Raise UnreadableError if the package cannot contain a file with this path in addition to the other files."""
    names = path.split("/")
    above = {"/".join(names[:number]) for number in range(1, len(names))}
    below = any(other.startswith(f"{path}/") for other in others)
    long = max(len(os.fsencode(name)) for name in names) > MOST_NAME or len(os.fsencode(path)) > tree.MAX_PATH_BYTES
    if below or long or not path.isprintable() or above & others:
        message = f"a cell of the notebook writes {shown(path[:100])}, which cannot be a file of the package"
        raise UnreadableError(message)
