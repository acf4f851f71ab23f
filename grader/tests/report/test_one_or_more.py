"""Messages about one thing are in the singular."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.report.logs import logs_of
from grader.report.scene import scene_of
from grader.tests.checks.made import evidence, good
from grader.tests.report.test_html import page_of
from grader.trial.observed import Track
from grader.trial.recording import Output

BELA = Track("bela", ((0.0, 1.0, 1.0, 0.0),))
ADA = Track("ada", ((0.0, 2.0, 2.0, 0.0),))


@pytest.mark.parametrize(
    ("tracks", "text"), [((BELA,), "other turtle: bela"), ((BELA, ADA), "other turtles: bela and ada")]
)
def test_the_legend_counts_the_other_turtles(tracks: tuple[Track, ...], text: str) -> None:
    assert ("other", text) in scene_of(evidence(replace(good(), tracks=tracks))).legend


@pytest.mark.parametrize(("dropped", "were"), [(1, "1 more byte was"), (2, "2 more bytes were")])
def test_a_log_counts_the_bytes_that_were_not_kept(dropped: int, were: str) -> None:
    given = evidence(replace(good(), stdout=Output("x\n", dropped, (0.0,))))
    assert f"{were} written but not kept." in [log.note for log in logs_of([given])]


@pytest.mark.parametrize(("lines", "text"), [(1, "1 looks like an error</strong>"), (2, "2 look like errors</strong>")])
def test_a_page_counts_the_errors_in_a_log(lines: int, text: str) -> None:
    output = Output("ValueError: x\n" * lines, 0, (0.0,) * lines)
    assert text in page_of(evidence(replace(good(), stderr=output)))
