from __future__ import annotations

import json

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.answers import GRAPH, LIST, TEXT
from grader.tests.checks.subjects.test_answers import TOPIC, judged


def as_toml(answer: str) -> str:
    """Return a string as TOML."""
    return json.dumps(answer, ensure_ascii=False)


@pytest.mark.parametrize(
    "answer", ["The overlay.", " overlay, ", "'overlay'", "“The overlay”.", '"the overlay."', "`overlay`!", "OVERLAY;"]
)
def test_quotation_marks_and_final_punctuation_do_not_matter(answer: str) -> None:
    assert judged(TEXT, as_toml(answer), accepts=("overlay", "the overlay")).status is Status.PASSED
    right = "the overlay" if "the" in answer.lower() else "overlay"
    assert judged(LIST, f"[{as_toml(answer)}, 'b.']", items=(right, "B")).status is Status.PASSED


@pytest.mark.parametrize(
    ("answer", "accepted"),
    [
        ("underlay.", "overlay"),
        ("over.lay", "overlay"),
        (".overlay", "overlay"),
        ("overlay?", "overlay"),
        ("overlay or underlay.", "overlay"),
        ("the 'overlay", "the overlay"),
        ("2.", "2"),
        ("-2.", "-2"),
        ("cd .", "cd"),
        ("install/..", "install/."),
        ("install/.", "install/"),
        (".", "overlay"),
        ("''", "overlay"),
        ("2", "2."),
        ("main", "'main'"),
    ],
)
def test_other_punctuation_does_matter(answer: str, accepted: str) -> None:
    assert judged(TEXT, as_toml(answer), accepts=(accepted,)).status is Status.FAILED
    assert judged(LIST, f"[{as_toml(answer)}]", items=(accepted,)).status is Status.FAILED
    assert judged(TEXT, as_toml(accepted), accepts=(accepted,)).status is Status.PASSED


@pytest.mark.parametrize(("answer", "diagnosis"), [("/cups.", None), (" '/cups' ", None), ("cups.", "no-slash")])
def test_a_name_may_be_followed_by_a_full_stop(answer: str, diagnosis: str | None) -> None:
    finding = judged(GRAPH, as_toml(answer), **TOPIC)
    assert finding.diagnosis == diagnosis
    if diagnosis is not None:
        assert finding.observed == f'name is "{answer}".'
