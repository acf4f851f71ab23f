"""Find folders of students whose names must not become ids in nbgrader's gradebook.

nbgrader compares names byte by byte. For the folder `ada`, nbgrader would add a second student next to `Ada`, and the
second student would get the points. nbgrader also prints ids as they are, including control characters.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.classroom.duplicates import similar
from grader.classroom.refused import Refused
from grader.exercise.own_numbers import normal_id
from grader.submission.tree import shown, sort_key

if TYPE_CHECKING:
    from collections.abc import Collection


def unclear(folders: Collection[str], enrolled: Collection[str]) -> dict[str, Refused]:
    """Map each folder name that is not a clear student id to the reason why its submissions are not graded.

    `enrolled` are the ids in the gradebook. A name is clear if it can be printed, and no other folder and no other id
    has the same normal form. If the name is an id in the gradebook, other folders with the same normal form do not
    matter, because anybody can create such a folder in nbgrader's exchange.
    """
    spellings: dict[str, set[str]] = {}
    for name in (*folders, *enrolled):
        spellings.setdefault(normal_id(name), set()).add(name)
    known = set(enrolled)
    found: dict[str, Refused] = {}
    for name in folders:
        alike = spellings[normal_id(name)]
        if len(alike) > 1 and alike & known != {name}:
            found[name] = _reason(name, sorted(alike, key=sort_key), known, folders)
        elif not name.isprintable():
            reason = f"The name {shown(name)} has characters that cannot be printed. Rename the folder."
            found[name] = Refused(reason, "submission-name")
    return found


def _reason(name: str, alike: list[str], enrolled: set[str], folders: Collection[str]) -> Refused:
    ids = enrolled.intersection(alike)
    if not ids:
        return similar(alike, "Remove or rename all of these folders but one.")
    if len(ids) == 1:
        (other,) = ids
        todo = f"Rename the folder {shown(name)} to {shown(other)}."
        if other in folders:
            todo = f"Keep only one of the folders, with the name {shown(other)}."
        return similar(alike, f"{shown(other)} is the id in the gradebook. {todo}")
    remove = "remove the ids from the gradebook (`nbgrader db student remove ID`)"
    return similar(alike, f"Keep one. Of the others, {remove}, and remove or rename the folders.")
