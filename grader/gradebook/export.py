"""`nbgrader export`: export only confirmed scores, and report unconfirmed scores."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from nbgrader.plugins import CsvExportPlugin

from grader.classroom.results import Results
from grader.common.words import a_list, count
from grader.gradebook.class_folders import CLASS, RESULTS
from grader.gradebook.confirmed import withhold_unconfirmed


class ConfirmedCsv(CsvExportPlugin):  # type: ignore[misc, unused-ignore]
    """Exports nbgrader's table with 0 points for every provisional score."""

    def export(self, gradebook: Any) -> None:  # noqa: ANN401 - as the base class
        """Withhold scores that are not confirmed, report these scores, and write the table."""
        course = self.parent.coursedir
        results = Results(Path(course.root) / CLASS / RESULTS)
        unconfirmed = withhold_unconfirmed(gradebook, results)
        if unconfirmed:
            names = [f"{each.student} ({each.step})" for each in unconfirmed]
            self.log.warning(
                "%s not confirmed, exported as 0 points: %s. Run `grader gradebook sync`, then grade the rest by hand.",
                count(len(names), "submission"),
                a_list(names),
            )
        super().export(gradebook)
