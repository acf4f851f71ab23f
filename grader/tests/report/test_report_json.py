from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.outcome import Finding, Outcome, Status
from grader.errors import UsageError
from grader.report.json import from_json, to_json
from grader.submission.where import Where
from grader.tests.report.reports import EVIDENCE, report

GOLDEN = Path(__file__).parent.parent / "golden" / "report"


@pytest.mark.parametrize("status", sorted(EVIDENCE))
def test_the_format_has_not_changed(status: str) -> None:
    """The JSON format of reports must not change, because other programs read these files.

    If a change is intended, increase SCHEMA and write the new text to golden/report/.
    """
    assert to_json(report(status)) == (GOLDEN / f"{status}.json").read_text("utf-8")


@pytest.mark.parametrize("status", sorted(EVIDENCE))
def test_a_report_survives_json_unchanged(status: str) -> None:
    for confined in (True, False, None):
        made = report(status, recording="kept/here", seed=7, confined=confined)
        assert from_json(to_json(made)) == made


def test_a_report_of_an_older_schema_is_read() -> None:
    made = report("passed")
    data = {key: value for key, value in json.loads(to_json(made)).items() if key != "confined"}
    assert from_json(json.dumps({**data, "schema": 1})) == made
    assert from_json(json.dumps({**json.loads(to_json(made)), "schema": 2, "max": 0.0})) == made
    with pytest.raises(UsageError, match="damaged"):
        from_json(json.dumps(data))


TEXTS = st.text(max_size=30)
FINDINGS = st.builds(
    Finding,
    status=st.sampled_from(Status),
    observed=TEXTS,
    expected=TEXTS,
    cause=TEXTS,
    diagnosis=st.none() | TEXTS,
    where=st.none() | st.builds(Where, TEXTS, st.none() | st.integers(1, 9)),
    near_edge=st.booleans(),
)


@given(FINDINGS, TEXTS)
def test_any_text_survives_json_unchanged(finding: Finding, name: str) -> None:
    outcome = Outcome("a", "b", "c", 0.5, 1.0, finding, hidden=True, advice=True)
    made = report("passed", outcomes=(outcome,), submission=name)
    assert from_json(to_json(made)) == made


def test_a_file_name_that_is_not_utf8_makes_valid_json() -> None:
    text = to_json(report("passed", submission="caf\udce9"))
    assert json.loads(text.encode())["submission"]["name"] == "caf\\udce9"


def test_half_of_a_surrogate_pair_from_a_recording_is_an_escape() -> None:
    text = to_json(report("passed", clock_why="odd \ud800"))
    assert json.loads(text.encode())["clock"]["why"] == "odd \ud800"


@pytest.mark.parametrize(
    ("text", "reported"),
    [
        ("", "not a report of the grader"),
        ("[]", "not a report of the grader"),
        ("{}", "not a report of the grader"),
        ('{"schema": 5}', "schema 5; this version of the grader reads schemas 1 to 4"),
        ('{"schema": 1}', "damaged"),
    ],
)
def test_a_text_that_is_not_a_report_is_a_usage_error(text: str, reported: str) -> None:
    with pytest.raises(UsageError, match=reported):
        from_json(text)


def test_a_report_with_an_unknown_status_is_damaged() -> None:
    text = to_json(report("passed")).replace('"status": "passed"', '"status": "splendid"')
    with pytest.raises(UsageError, match="damaged"):
        from_json(text)


def test_checks_that_were_not_judged_stay_in_the_maximum() -> None:
    made = report("passed")
    broken = replace(made.outcomes[-2], points=0.0, finding=Finding(Status.ERROR, "The disk is full."))
    data = json.loads(to_json(replace(made, outcomes=(*made.outcomes[:-2], broken))))
    assert (data["points"], data["max"]) == (95.0, 100.0)
