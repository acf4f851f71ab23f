"""Submissions whose student is not clear: a student has several submissions, or names of students are too similar.

Two names are one student id if they have the same normal form (grader.exercise.own_numbers.normal_id). Each of these
names has its own result, with the same individual numbers, because a student who chooses the name of an archive could
otherwise take the points of another student. The reports say that the names are one id. Several submissions with
exactly the same name are not graded, because they have a single line in the table of the class.
"""

from __future__ import annotations

import os
from dataclasses import replace
from typing import TYPE_CHECKING

from grader.classroom.refused import Refused
from grader.common.words import a_list
from grader.exercise.own_numbers import SAME, normal_id
from grader.submission.tree import shown, sort_key

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from grader.classroom.found import Found


def without_duplicates(found: Iterable[Found]) -> Iterator[Found]:
    """Yield one submission per name and exercise.

    If a name has several submissions, one of them is yielded, with the reason why none of them is graded. If several
    names are the same student id, each of their submissions gets a remark (`Found.alike`).
    """
    alike: dict[tuple[str, str], dict[str, list[Found]]] = {}
    for each in found:
        by_name = alike.setdefault((normal_id(each.student), each.exercise), {})
        by_name.setdefault(each.student, []).append(each)
    for by_name in alike.values():
        names = sorted(by_name, key=sort_key)
        why = similar(names, "Each of them has its own result.").reason if len(names) > 1 else ""
        yield from (replace(_one_of(each), alike=why) for each in by_name.values())


def similar(names: Sequence[str], todo: str) -> Refused:
    """Return a message which says that these names are one student id. `todo` is its end."""
    return Refused(f"{a_list([shown(name) for name in names])} are one student id: {SAME}. {todo}", "similar-names")


def _one_of(alike: Sequence[Found]) -> Found:
    """Return a student's only submission for an exercise.

    If the student handed in several submissions, return one of them with the reason why none of them is graded.
    """
    if len(alike) == 1:
        return alike[0]
    folder = os.path.commonpath([each.path.parent for each in alike])  # students do not need the instructor's paths
    paths = a_list([shown(os.path.relpath(each.path, folder)) for each in alike])
    text = f"{len(alike)} submissions: {paths}. Remove or rename all of these submissions but one."
    return replace(alike[0], refused=Refused(f"{shown(alike[0].student)} has {text}", "several-submissions"))
