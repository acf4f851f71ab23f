"""`nbgrader export`: export 0 points for each unconfirmed score, and report these scores.

nbgrader's own export writes names without quotes. With a name such as "anna,,,,100,0,100,100", a student could change
any score in the table.
"""

from __future__ import annotations

import csv
import io
import stat
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nbgrader.plugins import CsvExportPlugin

from grader.classroom.results import Results
from grader.common.whole_file import write_whole
from grader.common.words import a_list, count, printable
from grader.gradebook.class_folders import CLASS, RESULTS
from grader.gradebook.confirmed import withhold_unconfirmed
from grader.gradebook.failed_disk import failed_disk
from grader.report.csv import without_formula

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

COLUMNS = (
    "assignment",
    "duedate",
    "timestamp",
    "student_id",
    "last_name",
    "first_name",
    "email",
    "raw_score",
    "late_submission_penalty",
    "score",
    "max_score",
)
"""The columns of nbgrader's table: https://nbgrader.readthedocs.io/en/stable/user_guide/managing_the_database.html"""


class ConfirmedCsv(CsvExportPlugin):  # type: ignore[misc, unused-ignore]
    """Exports nbgrader's table with 0 points for every score that is not confirmed."""

    def export(self, gradebook: Any) -> None:  # noqa: ANN401 - as the base class
        """Withhold scores that are not confirmed, report these scores, and write the table."""
        course = self.parent.coursedir
        results = Results(Path(course.root) / CLASS / RESULTS)
        unconfirmed = withhold_unconfirmed(gradebook, results)
        if unconfirmed:
            # A submission appears once for each reason why some of its scores are not confirmed.
            names = list(dict.fromkeys(printable(f"{each.student} ({each.step})") for each in unconfirmed))
            self.log.warning(
                "%s with scores that are not confirmed and count 0 points: %s. Run `grader gradebook sync`, then grade "
                "the rest by hand.",
                count(len(names), "submission"),
                a_list(names),
            )
        table = io.StringIO(newline="")
        writer = csv.writer(table, lineterminator="\n")
        writer.writerow(COLUMNS)
        writer.writerows(_rows(gradebook, set(map(str, self.assignment)), set(map(str, self.student))))
        file = Path(self.to or "grades.csv")
        try:
            _write(file, table.getvalue().encode("utf-8", "backslashreplace"))
        except OSError as error:
            reason = failed_disk(error, file) or f"{file} could not be written: {error.strerror}."
            self.log.critical("%s An older table is unchanged.", reason)
            sys.exit(1)
        self.log.info("Exported the grades to %s", file)


def _write(file: Path, content: bytes) -> None:
    """Write the file, completely or not at all, unless it is a pipe or a device. Raises OSError."""
    if file.exists() and not file.is_file():
        file.write_bytes(content)
        return
    file = file.resolve()
    write_whole(file, content, mode=stat.S_IMODE(file.stat().st_mode) if file.exists() else None)


def _rows(gradebook: Any, steps: Collection[str], students: Collection[str]) -> Iterator[list[str]]:  # noqa: ANN401
    """Yield a row for each combination of an assignment in `steps` and a student in `students`.

    If `steps` is empty, all assignments are used. If `students` is empty, all students are used.
    """
    for assignment in gradebook.assignments:
        submissions = {each.student.id: each for each in assignment.submissions}
        for student in gradebook.students:
            if (steps and assignment.name not in steps) or (students and student.id not in students):
                continue
            names = (student.id, student.last_name, student.first_name, student.email)
            submission = submissions.get(student.id)
            when, raw, penalty = "", 0.0, 0.0
            if submission is not None:
                when, raw, penalty = submission.timestamp, submission.score, submission.late_submission_penalty or 0.0
            yield [
                without_formula(assignment.name),
                _text(assignment.duedate),
                _text(when),
                *(without_formula(_text(name)) for name in names),
                _text(raw),
                _text(penalty),
                _text(max(0.0, raw - penalty)),
                _text(assignment.max_score),
            ]


def _text(value: object) -> str:
    return "" if value is None else str(value)
