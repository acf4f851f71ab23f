"""Each diagnosis is in at most one group, and every diagnosis in a group exists."""

from __future__ import annotations

from collections import Counter

from grader.checks.certain import CONCLUSIONS, FROM_CONTENT, FROM_EXCEPTIONS, FROM_FILES, FROM_GRAPH, FROM_ORDER
from grader.checks.diagnoses import DIAGNOSES

GROUPS = (FROM_FILES, FROM_EXCEPTIONS, FROM_GRAPH, FROM_CONTENT, FROM_ORDER, CONCLUSIONS)


def test_the_groups_do_not_overlap() -> None:
    times = Counter(diagnosis for group in GROUPS for diagnosis in group)
    assert [diagnosis for diagnosis, number in times.items() if number > 1] == []


def test_every_diagnosis_in_a_group_exists() -> None:
    assert set(DIAGNOSES) >= frozenset[str]().union(*GROUPS)
