"""The sample of mistakes that `make test` grades.

The sample covers every group of diagnoses, and for each exercise a mistake that the files show and a mistake that only
the behaviour shows. The sample also contains one diagnosis of each group that no other test covers, if there is one. A
test of the checks judges an invented recording, which takes milliseconds. A case takes one to three seconds, or at
least ten seconds if it needs a trial in wall time. `make test-all` grades all cases.
"""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING

from grader.checks.diagnoses import GROUPS
from grader.checks.diagnoses_of_files import OF_FILES
from grader.tests.case import BASES, exercise_of
from grader.tests.catalogue import SHOWN_BY_TESTS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.tests.case import Case

MOST_OF_GROUP = 1
"""The number of diagnoses of a group that the sample includes because no test of the checks expects them."""
WALL = re.compile(r"\btime\b|spin_once|sleep|thread|asyncio|datetime|subprocess")
"""If source code contains one of these words, it probably needs a trial in wall time."""
WALL_COST = 5
"""The cost of a case that needs wall time. Other cases have the cost 1. The sample prefers cases that show many
features for their cost."""


def sample(cases: Sequence[Case]) -> frozenset[str]:
    """Return the names of the cases in the sample. The same cases and version of rclpy always give the same sample."""
    fit = [case for case in cases if case.is_of_this_rclpy]
    shown = {case.name: shows(case) for case in fit}
    cost = {case.name: WALL_COST if lives_in_wall_time(case) else 1 for case in fit}
    wanted = frozenset[object]().union(*shown.values())
    chosen: set[str] = set()
    while wanted:
        best = max(sorted(shown), key=lambda name: len(shown[name] & wanted) / cost[name])
        chosen.add(best)
        wanted -= shown[best]
    return frozenset(chosen)


def shows(case: Case) -> frozenset[object]:
    """Return the features of a case that the sample must show.

    The result contains the groups of the case's diagnoses, its exercise with the place that shows the mistake ("files"
    or "behaviour"), and its diagnoses that are in `without_test()`.
    """
    exercise = exercise_of(case)
    diagnoses = frozenset(case.diagnosis.values())
    groups = {group for group, of_group in GROUPS.items() if diagnoses & of_group.keys()}
    places = {(exercise, "files" if group in OF_FILES else "behaviour") for group in groups}
    return (diagnoses & without_test()) | groups | places


def lives_in_wall_time(case: Case) -> bool:
    """Return whether the case probably needs a trial in wall time."""
    source = "".join(edit["new"] for edit in case.edit)
    source += "".join(path.read_text("utf-8", "replace") for path in (case.folder / "files").rglob("*.py"))
    return case.clock == "wall" or WALL.search(source) is not None


@cache
def without_test() -> frozenset[str]:
    """Return, for each group, at most MOST_OF_GROUP diagnoses whose ids no test of the checks expects.

    An id of one word can appear in a test for another reason, so its appearance does not count.
    """
    source = "".join(path.read_text("utf-8") for path in sorted((BASES.parent / "checks").rglob("*.py")))
    chosen: list[str] = []
    for diagnoses in GROUPS.values():
        missing = [id_ for id_ in diagnoses if "-" not in id_ or f'"{id_}"' not in source]
        chosen += [id_ for id_ in missing if id_ not in SHOWN_BY_TESTS][:MOST_OF_GROUP]
    return frozenset(chosen)
