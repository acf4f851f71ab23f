"""The mistakes that `make test` grades: few cases that together show everything that `make test` must show.

They show each group of diagnoses in each exercise, and each diagnosis that no test of the checks expects. A test of the
checks judges an invented recording, which takes milliseconds. A case takes one to three seconds, and at least ten if
wall time judges it.
"""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING

from grader.checks.diagnoses import DIAGNOSES, GROUPS
from grader.tests.case import BASES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.tests.case import Case

OF_BASES = "03-circle-publisher"
"""The exercise of the packages in bases/."""
WALL = re.compile(r"\btime\b|spin_once|sleep|thread|asyncio|datetime|subprocess")
"""Source code with one of these words is likely to be judged in wall time."""
WALL_COST = 5
"""A case in wall time is chosen only if it shows more than this many times as much as any other case."""


def sample(cases: Sequence[Case]) -> frozenset[str]:
    """Return the names of the cases in the sample. The same cases always give the same sample."""
    shown = {case.name: shows(case) for case in cases}
    cost = {case.name: WALL_COST if lives_in_wall_time(case) else 1 for case in cases}
    wanted = frozenset[object]().union(*shown.values())
    chosen: set[str] = set()
    while wanted:
        best = max(sorted(shown), key=lambda name: len(shown[name] & wanted) / cost[name])
        chosen.add(best)
        wanted -= shown[best]
    return frozenset(chosen)


def shows(case: Case) -> frozenset[object]:
    """Return what the case shows: its diagnoses that no test of the checks expects, and (exercise, group)."""
    exercise = case.exercise or (OF_BASES if (BASES / case.base).is_dir() else case.base)
    diagnoses = frozenset(case.diagnosis.values())
    return (diagnoses - expected_by_tests()) | {(exercise, _groups()[id_]) for id_ in diagnoses & DIAGNOSES.keys()}


def lives_in_wall_time(case: Case) -> bool:
    """Return whether wall time is likely to judge the case."""
    source = "".join(edit["new"] for edit in case.edit)
    source += "".join(path.read_text("utf-8", "replace") for path in (case.folder / "files").rglob("*.py"))
    return case.clock == "wall" or WALL.search(source) is not None


@cache
def expected_by_tests() -> frozenset[str]:
    """Return the diagnoses that a test of the checks expects by their id.

    An id of one word may be there for another reason, so a case must show it.
    """
    source = "".join(path.read_text("utf-8") for path in sorted((BASES.parent / "checks").rglob("*.py")))
    return frozenset(id_ for id_ in DIAGNOSES if "-" in id_ and f'"{id_}"' in source)


@cache
def _groups() -> dict[str, str]:
    return {id_: group for group, diagnoses in GROUPS.items() for id_ in diagnoses}
