"""Convert a report to JSON and back.

Schema 4. Every key except `change` is always present. Strings are never null unless stated below.

    schema        4; schemas 1 to 3 can be read too: 1 has no `confined`; in 1 and 2, `max` excludes checks with
                  "error"; 1 to 3 have no `tried`
    exercise      {id, title, sha256 of exercise.toml}
    submission    {name as the user typed it, sha256 of its files}
    grader, ros   their versions
    clock         {used: "simulated" or "wall" ("none" if the first trial has no recording), why: a sentence}
    confined      false if the student's code ran without a sandbox, with resource limits only; null if this is not
                  known, in a report on a recording from an earlier version
    seed          the value of --seed, for random inputs such as the start pose; null without --seed, or if the
                  first trial has no recording
    points, max   sums over the outcomes; a check with status "error" counts 0 points
    outcomes      [{id, kind, title, status: "passed", "failed", "skipped" or "error", points, max, seen, expected,
                  cause, diagnosis: stable id of the cause or null, where: {file, line or null} or null, hidden,
                  advice: true if a failure costs no points and does not prevent a pass, near_edge,
                  tried: the result of fixing the cause in a copy, or an empty string,
                  change: that change as a unified diff, only if it has confirmed the cause}]
    seconds       {stage: wall time in s}; differs from run to run
    recordings    [paths of the recordings that were kept]
"""

from __future__ import annotations

import json
from typing import Any

from grader.checks.outcome import Finding, Outcome, Status
from grader.common.json_types import number, text, text_or_none, whole_or_none
from grader.errors import UsageError
from grader.report.report import Report
from grader.submission.where import Where

SCHEMA = 4
READ = (1, 2, 3, SCHEMA)
MOST_OUTCOMES = 1000
"""The maximum number of outcomes in a report that is read. Students can write reports with any number of them."""


def to_json(report: Report) -> str:
    """Return the report as indented JSON that ends with a newline.

    UTF-8 cannot encode a lone surrogate, which a recording may contain. It is written as a JSON escape sequence.
    """
    text = json.dumps(to_data(report), ensure_ascii=False, indent=2, allow_nan=False) + "\n"
    return text.encode("utf-8", "backslashreplace").decode()


def to_data(report: Report) -> dict[str, Any]:
    """Return the report as dictionaries and lists, ready for JSON."""
    return {
        "schema": SCHEMA,
        "exercise": {"id": report.exercise, "title": report.exercise_title, "sha256": report.exercise_digest},
        "submission": {"name": _encodable(report.submission), "sha256": report.digest},
        "grader": report.grader,
        "ros": report.ros,
        "clock": {"used": report.clock, "why": report.clock_why},
        "confined": report.confined,
        "seed": report.seed,
        "points": report.points,
        "max": report.max,
        "outcomes": [_outcome(outcome) for outcome in report.outcomes],
        "seconds": dict(report.seconds),
        "recordings": [] if report.recording is None else [_encodable(report.recording)],
    }


def _outcome(outcome: Outcome) -> dict[str, Any]:
    finding = outcome.finding
    where = finding.where
    return {
        "id": outcome.id,
        "kind": outcome.kind,
        "title": outcome.title,
        "status": finding.status.value,
        "points": outcome.points,
        "max": outcome.max,
        "seen": _encodable(finding.observed),
        "expected": _encodable(finding.expected),
        "cause": _encodable(finding.cause),
        "diagnosis": finding.diagnosis,
        "where": None if where is None else {"file": _encodable(where.file), "line": where.line},
        "hidden": outcome.hidden,
        "advice": outcome.advice,
        "near_edge": finding.near_edge,
        "tried": finding.tried,
        **({"change": _encodable(finding.change)} if finding.change else {}),
    }


def _encodable(text: str) -> str:
    """Replace lone surrogates with escapes, because JSON must be valid UTF-8.

    In a file name, Python represents each byte that is not valid UTF-8 by a lone surrogate.
    """
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def from_json(written: str) -> Report:
    """Read a report from JSON. Raises UsageError if the text is not a report, is damaged, or has an unknown schema."""
    try:
        data = json.loads(written)
        schema = data["schema"]
    except (ValueError, TypeError, KeyError, RecursionError) as error:
        message = "This is not a report of the grader: it is not JSON with the key `schema`."
        raise UsageError(message) from error
    if schema not in READ:
        message = f"This report has schema {schema}; this version of the grader reads schemas {READ[0]} to {READ[-1]}."
        raise UsageError(message)
    try:
        return _report(data)
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        message = f"This report is damaged: {type(error).__name__} {error}."
        raise UsageError(message) from error


def _report(data: dict[str, Any]) -> Report:
    recordings = data["recordings"]
    if len(data["outcomes"]) > MOST_OUTCOMES:
        message = f"it has more than {MOST_OUTCOMES} outcomes"
        raise ValueError(message)
    return Report(
        exercise=text(data["exercise"]["id"]),
        exercise_title=text(data["exercise"]["title"]),
        submission=text(data["submission"]["name"]),
        digest=text(data["submission"]["sha256"]),
        grader=text(data["grader"]),
        ros=text(data["ros"]),
        clock=text(data["clock"]["used"]),
        clock_why=text(data["clock"]["why"]),
        confined=True if data["schema"] == 1 else None if data["confined"] is None else bool(data["confined"]),
        seed=whole_or_none(data["seed"]),
        outcomes=tuple(_read_outcome(each) for each in data["outcomes"]),
        seconds={text(stage): number(seconds) for stage, seconds in data["seconds"].items()},
        recording=text(recordings[0]) if recordings else None,
        exercise_digest=text(data["exercise"]["sha256"]),
    )


def _read_outcome(data: dict[str, Any]) -> Outcome:
    where = data["where"]
    if not 0 <= number(data["points"]) <= number(data["max"]):
        message = f"the check {text(data['id'])!r:.80} has {data['points']} of {data['max']} points"
        raise ValueError(message)
    finding = Finding(
        status=Status(data["status"]),
        observed=text(data["seen"]),
        expected=text(data["expected"]),
        cause=text(data["cause"]),
        diagnosis=text_or_none(data["diagnosis"]),
        where=None if where is None else Where(text(where["file"]), whole_or_none(where["line"])),
        near_edge=bool(data["near_edge"]),
        tried=text(data.get("tried", "")),
        change=text(data.get("change", "")),
    )
    return Outcome(
        id=text(data["id"]),
        kind=text(data["kind"]),
        title=text(data["title"]),
        points=number(data["points"]),
        max=number(data["max"]),
        finding=finding,
        hidden=bool(data["hidden"]),
        advice=bool(data["advice"]),
    )
