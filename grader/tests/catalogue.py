"""The page for authors that lists every diagnosis with its meaning and its cases.

    python -m grader.tests.catalogue

updates grader/checks/README.md.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from grader.checks.diagnoses import GROUPS
from grader.exercise.model import catalogue
from grader.tests.case import CASES, exercise_of, read_cases

if TYPE_CHECKING:
    from grader.tests.case import Case

TESTS = Path(__file__).parent
PAGE = TESTS.parent / "checks" / "README.md"
MISTAKES = CASES.parent / "mistakes"
UNUSUAL = CASES.parent / "unusual"
SHOWN_BY_TESTS = {
    "action-type": "checks/subjects/test_goals.py",
    "goal-aborted": "checks/subjects/test_goals.py",
    "goal-not-reached": "checks/subjects/test_goals.py",
    "stale-feedback": "checks/subjects/test_feedback.py",
    "build-limit": "checks/subjects/test_building.py",
    "lobe-gap": "checks/subjects/test_eight.py",
    "no-answers-file": "classroom/test_task.py",
    "no-commands": "checks/subjects/test_values.py",
    "no-package": "classroom/test_grade_class.py",
    **dict.fromkeys(
        (
            *("several-packages", "several-submissions", "similar-names", "exercise-missing", "submission-name"),
            *("submission-link", "archive-damaged", "archive-format", "submission-too-large"),
        ),
        "classroom/test_refused.py",
    ),
    "no-timer": "checks/subjects/test_running.py",
    "numbers-of-another": "checks/subjects/test_own.py",
    "overwhelmed": "checks/test_judge.py",
    "package-xml-not-installed": "checks/subjects/test_installed.py",
    "publisher-in-callback": "checks/causes/test_why_rate.py",
    "resource-marker": "checks/subjects/test_installed.py",
    "slow-stop": "checks/subjects/test_running.py",
    "unsteady-tests": "checks/subjects/test_tests_run.py",
    "square-gap": "checks/subjects/test_square.py",
    "too-soon": "checks/subjects/test_square.py",
    "unreadable": "checks/test_judge.py",
}
"""Maps each diagnosis that no case shows to the test that shows it."""
HEAD = """\
# The catalogue of mistakes

The cause of a failed check has a stable id, the diagnosis. This page lists each diagnosis with cases that show it.
A case is a folder with a submission and with the requirements for its report. The folder is in
`grader/tests/mistakes/` (the tables below contain only its number) or in `grader/tests/cases/`. A few diagnoses are
shown by a test instead of a case. [diagnoses.py](diagnoses.py) contains the ids and their meanings.
`python -m grader.tests.catalogue` generates this page, and a test fails when the page is out of date.

To add a mistake:

1. Make a folder `grader/tests/mistakes/NNN-name/` with a new number. Put a file `expected.toml` into it. The keys of
   that file are the fields of `Case` in [case.py](../tests/case.py), except `name` and `folder`. The submission is a
   base, such as the solution of a step, with the files in the folder and the edits in `expected.toml`.
2. If no id fits, add one to [diagnoses.py](diagnoses.py) and [diagnosis.py](diagnosis.py). The code that recognizes the
   mistake belongs in the module of its subject or cause.
3. Run the case:

```text
python -m pytest -m "" grader/tests/test_mistakes.py -k NNN
```

A message has at most 60 words: what was observed, what was expected, and the cause. Nearly every message also names a
file. A message never contains a line of the solution. Tests check these rules. A false diagnosis is worse than none. In
`expected.toml`, list under `never` what the report must not contain.
"""


def cases() -> tuple[Case, ...]:
    """Return all cases that name diagnoses."""
    return (*read_cases(CASES), *read_cases(MISTAKES))


def page() -> str:
    """Return the whole page."""
    shown: dict[str, list[str]] = {}
    for case in cases():
        for id_ in dict.fromkeys(case.diagnosis.values()):
            shown.setdefault(id_, []).append(_number(case))
    parts = [HEAD, _amounts()]
    for group, diagnoses in GROUPS.items():
        rows = [f"| `{id_}` | {meaning} | {_shown(id_, shown)} |" for id_, meaning in diagnoses.items()]
        parts.append(
            "\n".join([f"## {group}", "", "| id | what it means | shown by |", "| --- | --- | --- |", *rows, ""])
        )
    return "\n".join(parts)


def amounts() -> dict[str, tuple[int, int, int]]:
    """Return the numbers of cases for each exercise.

    The numbers count the mistakes that a report names, the diagnoses that these mistakes show, and the correct
    submissions that differ from our solution.
    """
    found = {}
    mistakes, unusual = read_cases(MISTAKES), read_cases(UNUSUAL)
    for exercise in catalogue():
        named = [case for case in mistakes if exercise_of(case) == exercise and case.diagnosis]
        shown = {id_ for case in named for id_ in case.diagnosis.values()}
        found[exercise] = (len(named), len(shown), sum(exercise_of(case) == exercise for case in unusual))
    return found


def _amounts() -> str:
    head = [
        "## Cases of each step",
        "",
        "The last column counts the correct submissions in `grader/tests/unusual/`, which differ from our solutions.",
        "",
        "| step | mistakes | diagnoses | unusual but correct |",
        "| --- | --- | --- | --- |",
    ]
    rows = [f"| {exercise} | {' | '.join(map(str, of_it))} |" for exercise, of_it in amounts().items()]
    return "\n".join([*head, *rows, ""])


def _number(case: Case) -> str:
    """Return a case's number, with the folder unless the folder is mistakes/: each folder's numbers start at 101."""
    number = case.name.partition("-")[0]
    return number if case.folder.parent == MISTAKES else f"{case.folder.parent.name}/{number}"


def _shown(id_: str, by_case: dict[str, list[str]]) -> str:
    """Return some of the cases that show this diagnosis, or else a test that shows this diagnosis."""
    names = by_case.get(id_, [])
    if not names and id_ in SHOWN_BY_TESTS:
        return f"[{Path(SHOWN_BY_TESTS[id_]).stem}](../tests/{SHOWN_BY_TESTS[id_]})"
    return ", ".join(names[:6]) + (f" and {len(names) - 6} more" if len(names) > 6 else "")


if __name__ == "__main__":
    PAGE.write_text(page(), "utf-8")
