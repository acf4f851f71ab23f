"""A report as Gradescope's results.json (see "Autograder Specifications", "Output Format" in its documentation).

Students can see results.json. For a hidden check, results.json contains only the result and the points.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from grader.checks.outcome import Status
from grader.common.words import printable
from grader.report.certainty import cause_sentence
from grader.report.hidden import for_students
from grader.report.verdict import verdict

if TYPE_CHECKING:
    from grader.checks.outcome import Outcome
    from grader.report.report import Report


def to_gradescope(report: Report) -> str:
    """Return the text of results.json."""
    shown = for_students(report)
    data = {
        "score": round(report.points, 6),
        "execution_time": round(report.seconds.get("in all", 0.0)),
        "output": printable(verdict(report)),
        "output_format": "text",
        # The scripts print only the progress of the grader, which is of no use to students.
        "stdout_visibility": "hidden",
        "visibility": "visible",
        "tests": [_test(number, outcome) for number, outcome in enumerate(shown.outcomes, 1)],
        "extra_data": {
            "exercise": report.exercise,
            "grader": report.grader,
            "ros": report.ros,
            "clock": report.clock,
            "submission_sha256": report.digest,
        },
    }
    return json.dumps(data, ensure_ascii=True, indent=1) + "\n"


def _test(number: int, outcome: Outcome) -> dict[str, Any]:
    passed = outcome.status is Status.PASSED
    test: dict[str, Any] = {
        "number": str(number),
        "name": printable(outcome.title),
        "name_format": "text",
        "output": _output(outcome),
        "output_format": "text",
        "visibility": "visible",
    }
    if outcome.max:
        test |= {"score": round(outcome.points, 6), "max_score": round(outcome.max, 6)}
    # Advice has no points, so without a status Gradescope would show it as failed.
    return {**test, "status": "passed" if passed or outcome.advice else "failed"}


def _output(outcome: Outcome) -> str:
    finding = outcome.finding
    if outcome.status is Status.PASSED and not outcome.hidden:
        return ""
    note = "This check is advice, and is worth no points." if outcome.advice else ""
    where = f"Where: {finding.where}" if finding.where else ""
    expected = f"Expected: {finding.expected}" if finding.expected else ""
    error = (
        "This check could not be judged. Your instructor can see this, too." if outcome.status is Status.ERROR else ""
    )
    return "\n".join(
        printable(text) for text in (note, error, finding.observed, expected, cause_sentence(outcome), where) if text
    )
