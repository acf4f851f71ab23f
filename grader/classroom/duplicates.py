"""Submissions that are not graded because the student is not clear: there are several, or their names are too similar.

Two names are one student id if they have the same normal form, as for the students' own numbers. One of the two could
be a spelling mistake, so the submissions are neither merged nor graded.
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
    """Yield one submission per name and exercise. If the student is not clear, it has the reason why not."""
    alike: dict[tuple[str, str], dict[str, list[Found]]] = {}
    for each in found:
        by_name = alike.setdefault((normal_id(each.student), each.exercise), {})
        by_name.setdefault(each.student, []).append(each)
    for by_name in alike.values():
        if len(by_name) == 1:
            yield from map(_one_of, by_name.values())
        else:
            why = similar(sorted(by_name, key=sort_key), "Remove or rename all of these submissions but one.")
            yield from (replace(each[0], refused=why) for each in by_name.values())


def similar(names: Sequence[str], todo: str) -> Refused:
    """Return why nothing is graded if these different names are one student id. `todo` says what to do."""
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
