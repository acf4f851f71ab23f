"""Each diagnosis has a case in which it is true, and a similar but correct package that must not get the diagnosis.

A case is a correct package with a few edits. The correct package is similar to the case. Therefore, a diagnosis that
did not depend on the mistake itself would also appear in the report on the correct package. All correct packages pass:
`test_course` tests the solutions, and `unusual/` has cases for the packages in bases/.
"""

from __future__ import annotations

import difflib
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from grader.checks.diagnoses import DIAGNOSES
from grader.tests.case import BASES, CASES, Case, make_submission, read_cases
from grader.tests.catalogue import cases

MOST_LINES = 13
"""A correct package is close to a case if at most this many lines were removed and added."""
FAR = {
    "answers-empty": "every line of the answers is missing",
    "assert-in-loop": "any other test that needs a message notices that none arrives",
    "bench-no-node": "tests that never create the node call functions of their own in every line",
    "empty-file": "every line of the file is missing",
    "loop-without-pause": "the clocks judge a node that never rests differently, so its cases replace whole files",
    "no-test-function": "every test of the file is missing",
    "polygon": "a polygon needs other commands than a circle",
    "spin-once": "whether the first event is the timer depends on the machine; the case was written for both",
    "test-class-init": "all tests are in a class, so every line of them is indented",
    "timer-in-callback": "thousands of timers slow a machine down; the case has its own time limit",
}
"""Maps a diagnosis to the reason why no correct package is similar to one of its cases."""


def test_a_right_package_is_close_to_a_case_of_each_diagnosis() -> None:
    shown = {id_ for case in cases() for id_ in case.diagnosis.values()}
    far = {id_: lines for id_ in shown if (lines := closest().get(id_, 999)) > MOST_LINES and id_ not in FAR}
    assert far == {}
    assert sorted(FAR.keys() - DIAGNOSES.keys()) == []


def test_the_packages_that_cases_are_laid_over_are_right() -> None:
    plain = {case.base for case in read_cases(CASES.parent / "unusual") if not case.edit and not case.remove}
    assert sorted({folder.name for folder in BASES.iterdir() if folder.is_dir()} - plain) == []


@cache
def closest() -> dict[str, int]:
    """Map each diagnosis to the number of lines in which one of its cases differs from its base.

    If a case differs in at most MOST_LINES, later cases of the same diagnoses need not be compared.
    """
    found: dict[str, int] = {}
    bases: dict[str, dict[str, list[str]]] = {}
    with TemporaryDirectory() as name:
        for number, case in enumerate(cases()):
            wanted = any(found.get(id_, MOST_LINES + 1) > MOST_LINES for id_ in case.diagnosis.values())
            if case.base and wanted:
                if case.base not in bases:
                    right = Case(name=case.base, why="", result="passed", base=case.base)
                    bases[case.base] = contents(right, Path(name) / f"right-{number}")
                lines = distance(bases[case.base], contents(case, Path(name) / str(number)))
                for id_ in set(case.diagnosis.values()):
                    found[id_] = min(lines, found.get(id_, lines))
    return found


def contents(case: Case, folder: Path) -> dict[str, list[str]]:
    """Return the lines of each file of the submission."""
    make_submission(case, folder)
    files = (path for path in folder.rglob("*") if path.is_file() and not path.is_symlink())
    return {path.relative_to(folder).as_posix(): lines_of(path) for path in files}


def lines_of(path: Path) -> list[str]:
    """Return the lines of a file. A file of a bag counts as one line, because a learner records it as a whole."""
    text = path.read_bytes().decode("latin-1")
    return [text] if path.suffix == ".mcap" or path.name == "metadata.yaml" else text.splitlines()


def distance(right: dict[str, list[str]], wrong: dict[str, list[str]]) -> int:
    """Return the number of removed and added lines.

    A file that exists in only one of the two packages counts as one line.
    """
    lines = len(right.keys() ^ wrong.keys())
    for path in right.keys() & wrong.keys():
        if right[path] != wrong[path]:
            lines += sum(line[0] in "+-" for line in difflib.unified_diff(right[path], wrong[path], n=0)) - 2
    return lines
