"""Copy the files of a submission that are safe to copy, for nbgrader or for a kernel."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.submission import tree
from grader.submission.package import Submission, write_copy
from grader.submission.reader import read

if TYPE_CHECKING:
    from pathlib import Path

MOST_REPORTED = 20
"""The maximum number of omitted entries that are reported."""


def copy_of(submission: Path, copy: Path, *, notebooks: bool = True) -> tuple[str, ...]:
    """Copy the files that `tree.read_folder` accepts from the folder `submission` to `copy`, which may already exist.

    Without `notebooks`, files that end in .ipynb are not copied. Return the reasons why entries were rejected.
    """
    found = read(tree.read_folder, submission, follow=False)
    files = {path: data for path, data in found.files.items() if notebooks or not path.endswith(".ipynb")}
    for path in files if copy.exists() else ():
        (copy / path).unlink(missing_ok=True)
    write_copy(Submission("", submission, files, (), "", frozenset(found.executable & files.keys())), copy)
    left_out = tuple(f"{tree.shown(path)} {why}" for path, why in sorted(found.rejected.items()))
    more = len(left_out) - MOST_REPORTED
    return (*left_out[:MOST_REPORTED], f"and {more} more") if more > 0 else left_out
