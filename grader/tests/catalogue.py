"""The author's page: every diagnosis, what it means, and the cases that show it.

    python -m grader.tests.catalogue

writes grader/checks/README.md anew.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from grader.checks.diagnoses import GROUPS
from grader.tests.case import CASES, read_cases

if TYPE_CHECKING:
    from grader.tests.case import Case

TESTS = Path(__file__).parent
PAGE = TESTS.parent / "checks" / "README.md"
MISTAKES = CASES.parent / "mistakes"
SHOWN_BY_TESTS = {
    "build-limit": "checks/subjects/test_building.py",
    "lobe-gap": "checks/subjects/test_eight.py",
    "no-commands": "checks/subjects/test_values.py",
    "no-timer": "checks/subjects/test_node.py",
    "numbers-of-another": "checks/subjects/test_own.py",
    "overwhelmed": "checks/test_judge.py",
    "package-xml-not-installed": "checks/subjects/test_building.py",
    "resource-marker": "checks/subjects/test_building.py",
    "slow-stop": "checks/subjects/test_node.py",
    "square-gap": "checks/subjects/test_square.py",
    "too-soon": "checks/subjects/test_square.py",
    "wrong-centre": "checks/subjects/test_path.py",
}
"""Diagnosis -> the test that shows it: no ordinary submission leads to it, but a hostile one, or a class."""
HEAD = """\
# The catalogue of mistakes

A check that fails names its cause by a stable id. This page lists them all, with the cases that show each:
folders in `grader/tests/mistakes/` and `grader/tests/cases/`, a submission with what must be said about it. A few
are shown by a test on made recordings, which stands in their place. The ids and meanings stand in
[diagnoses.py](diagnoses.py); this page is made from them and from the cases by `python -m grader.tests.catalogue`,
and a test fails when it is stale.

A new mistake is a folder `grader/tests/mistakes/NNN-name/` with the submission and an expected.toml (its keys
are the fields of `Case` in [case.py](../tests/case.py)), and, where none of the ids fits, a new one: the code
that recognises it, in the module of its subject, and its line in diagnoses.py. What it says has at most 60
words, tells what was seen, what was expected and where, and never has a line of the solution in it; tests hold
that, too. One that the evidence does not support is worse than none: `never` in expected.toml lists what must
not be said.

```text
python -m pytest grader/tests/test_mistakes.py -k NNN
```
"""


def cases() -> tuple[Case, ...]:
    """All cases that name diagnoses."""
    return (*read_cases(CASES), *read_cases(MISTAKES))


def page() -> str:
    """The whole page."""
    shown: dict[str, list[str]] = {}
    for case in cases():
        for id_ in dict.fromkeys(case.diagnosis.values()):
            shown.setdefault(id_, []).append(case.name.partition("-")[0])
    parts = [HEAD]
    for group, diagnoses in GROUPS.items():
        rows = [f"| `{id_}` | {meaning} | {_shown(id_, shown)} |" for id_, meaning in diagnoses.items()]
        title = group[0].upper() + group[1:]
        parts.append(
            "\n".join([f"## {title}", "", "| id | what it means | shown by |", "| --- | --- | --- |", *rows, ""])
        )
    return "\n".join(parts)


def _shown(id_: str, by_case: dict[str, list[str]]) -> str:
    """What shows a diagnosis: some of the cases, else a test."""
    names = by_case.get(id_, [])
    if not names and id_ in SHOWN_BY_TESTS:
        return f"[{Path(SHOWN_BY_TESTS[id_]).stem}](../tests/{SHOWN_BY_TESTS[id_]})"
    return ", ".join(names[:6]) + (f" and {len(names) - 6} more" if len(names) > 6 else "")


if __name__ == "__main__":
    PAGE.write_text(page(), "utf-8")
