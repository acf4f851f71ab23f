"""The page of a submission whose recording cannot be drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.errors import UnreadableError
from grader.report.html import html_page
from grader.tests.report.reports import EVIDENCE, report_of

if TYPE_CHECKING:
    import pytest

SENTENCE = "There is no recording of a run"


def test_a_recording_that_cannot_be_drawn_is_not_said_to_be_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> str:
        raise UnreadableError("it is too large to be read")  # noqa: EM101

    monkeypatch.setattr("grader.report.html.read", refuse)
    assert SENTENCE not in html_page(EVIDENCE["failed"], report_of(EVIDENCE["failed"]))


def test_a_recording_that_does_not_exist_is_said_to_be_missing() -> None:
    unbuilt = next(given for given in EVIDENCE.values() if given.run.recording is None)
    assert SENTENCE in html_page(unbuilt, report_of(unbuilt))
