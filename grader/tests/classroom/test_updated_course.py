"""A class that is graded before and after an update of the course, or during it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.classroom import grade_class
from grader.classroom.found import Found
from grader.classroom.order import Order, sort_out, sources_for
from grader.classroom.results import opened
from grader.sandbox import bubblewrap
from grader.tests.classroom.test_again import STEP, Scripted
from grader.tests.report.reports import report

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(
    ("older", "why"),
    [
        ({"grader": "0.0.1 0123456789abcdef"}, "graded by another version of the grader"),
        # Another version may also have computed the hash in another way.
        (
            {"grader": "0.0.1 0123456789abcdef", "submission": "0" * 64, "student": "?"},
            "graded by another version of the grader",
        ),
        ({"submission": "0" * 64}, "changed"),
    ],
)
def test_the_reason_for_grading_again_is_the_update(tmp_path: Path, older: dict[str, str], why: str) -> None:
    (tmp_path / "class/anna").mkdir(parents=True)
    found = (Found("anna", STEP, tmp_path / "class/anna"),)
    order = Order(found=found, roster={}, sources=sources_for(found, None), ros="none")
    with opened(tmp_path / "grades") as results:
        key = order.key(found[0])
        results.save("anna", report("passed"), replace(key, **older), b"a page")
        kept, todo = sort_out(order, results)
    assert (kept, [each.why for each in todo]) == ([], [why])


@pytest.mark.parametrize("updates", [False, True])
def test_an_update_during_a_run_is_reported_with_the_marks(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, updates: bool
) -> None:
    (tmp_path / "class/anna").mkdir(parents=True)
    (tmp_path / "class/anna/notes.txt").touch()
    monkeypatch.setattr(grade_class, "_ros", lambda **_: "none")
    monkeypatch.setattr(grade_class, "_engine", lambda *_, **__: Scripted({"anna": ["passed"]}))
    monkeypatch.setattr(bubblewrap, "require", lambda **_: True)
    monkeypatch.setattr(grade_class, "updated", lambda: updates)
    said: list[str] = []
    request = grade_class.Request([tmp_path / "class"], tmp_path / "grades", STEP)
    grade_class.grade_class(request, said.append, lambda _: None)
    assert (grade_class.UPDATED in said) == updates
    said.clear()
    grade_class.grade_class(request, said.append, lambda _: None)  # nothing is graded, so nothing is mixed
    assert grade_class.UPDATED not in said
