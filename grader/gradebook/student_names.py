"""Compare the names of students' folders with each other and with the ids in nbgrader's gradebook.

nbgrader compares names byte by byte. With the folder `ada`, it would add a second student next to `Ada`, and the points
would be in the wrong row.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.classroom.duplicates import similar
from grader.exercise.own_numbers import normal_id
from grader.submission.tree import shown, sort_key

if TYPE_CHECKING:
    from collections.abc import Collection

    from grader.classroom.refused import Refused


def unclear(folders: Collection[str], enrolled: Collection[str]) -> dict[str, Refused]:
    """Map each folder name that could mean another student to the reason why its submissions are not graded.

    `enrolled` are the ids in the gradebook. A folder is clear if no other folder and no other id has the same normal
    form.
    """
    spellings: dict[str, set[str]] = {}
    for name in (*folders, *enrolled):
        spellings.setdefault(normal_id(name), set()).add(name)
    known = set(enrolled)
    return {
        name: _reason(name, sorted(spellings[normal_id(name)], key=sort_key), known)
        for name in folders
        if len(spellings[normal_id(name)]) > 1
    }


def _reason(name: str, alike: list[str], enrolled: set[str]) -> Refused:
    if enrolled.isdisjoint(alike):
        return similar(alike, "Keep one of these folders, and remove or rename the others.")
    if name not in enrolled and len(alike) == 2:
        (other,) = set(alike) - {name}
        rename = f"Rename the folder {shown(name)} to {shown(other)}."
        return similar(alike, f"{shown(other)} is the id in the gradebook. {rename}")
    return similar(alike, "Keep one of them, in the gradebook (`nbgrader db student remove ID`) and as a folder.")
