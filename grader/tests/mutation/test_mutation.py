"""The mutation test with one real case: the case notices a change that removes its diagnosis."""

from __future__ import annotations

import multiprocessing
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.tests.case import CASES, ROOT, read_case
from grader.tests.mutation import equivalent, judging
from grader.tests.mutation.mutants import DETAIL, Mutant, mutants_of
from grader.tests.mutation.recordings import Recorded, recordings

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

ANSWERS = ROOT / "grader" / "checks" / "subjects" / "answers.py"
WHY = ROOT / "grader" / "checks" / "causes" / "why_answer.py"
CASE = CASES.parent / "mistakes" / "201-no-slash"

SOURCE = '''
"""A text."""
from typing import TYPE_CHECKING
if TYPE_CHECKING:
    from a import b
LIMIT: float = 1.5
class Params:
    width: float = number(2.0)
def check(value, where: int = 3) -> "A | B":
    """What it is."""
    seen = f"It is {value + 1}."
    if value > LIMIT:
        return failed("too-large", seen, where=where)
    return passed("1")
'''


def changes(tmp_path: Path, source: str) -> list[tuple[int, str]]:
    (tmp_path / "a.py").write_text(source, "utf-8")
    return [(mutant.line, mutant.change) for mutant in mutants_of(tmp_path / "a.py")]


def test_mutants_change_conditions_but_not_declarations_or_words(tmp_path: Path) -> None:
    found = changes(tmp_path, SOURCE)
    assert sorted({line for line, _ in found}) == [6, 12, 13, 14]
    assert (12, "> LIMIT -> >= LIMIT") in found
    assert (12, "if value > LIMIT -> if False") in found
    assert (13, '"too-large" -> "another"') in found
    assert (13, 'return failed("too-large", seen, where=where) -> pass') in found


CHOICES = """
def check(value):
    told = "it is large" if value > 1 else "it is small"
    told = "what is said"
    diagnosis = "no-slash" if value > 2 else "capitals"
    diagnosis = "no-slash"
    if value > 3:
        return None
    Cause(diagnosis, told, value)
    return None
"""


def test_mutants_change_ids_but_not_sentences(tmp_path: Path) -> None:
    found = changes(tmp_path, CHOICES)
    assert sorted({line for line, _ in found}) == [5, 6, 7, 8, 9]
    assert [line for line, change in found if change == '"no-slash" -> "another"'] == [5, 6]
    assert (5, '"capitals" -> "another"') in found
    assert {(9, 'diagnosis -> "another"'), (9, "value -> None")} < set(found)


def test_a_mutant_is_python_with_one_change(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text(SOURCE, "utf-8")
    for mutant in mutants_of(tmp_path / "a.py"):
        compile(mutant.source, "a.py", "exec")
        before, after = SOURCE.splitlines(), mutant.source.splitlines()
        changed = [number for number, pair in enumerate(zip(before, after, strict=False), 1) if pair[0] != pair[1]]
        assert changed[0] == mutant.line, str(mutant)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("recordings")


@pytest.fixture(scope="module")
def recorded(folder: Path) -> list[Recorded]:
    return recordings([read_case(CASE)], lambda _: None, folder)


def test_a_case_is_recorded_once(recorded: list[Recorded], folder: Path) -> None:
    reported: list[str] = []
    assert (recordings([read_case(CASE)], reported.append, folder), reported) == (recorded, [])
    assert [each.name for each in recorded] == ["mistakes/201-no-slash"]


def noticed(recorded: list[Recorded], file: Path, change: str) -> dict[str, bool]:
    """Return whether the case notices each mutant of the file with this change.

    A child process runs the checks, because the test unloads their modules.
    """
    wanted = [mutant for mutant in mutants_of(file) if change in mutant.change]
    assert wanted
    with multiprocessing.get_context("fork").Pool(1) as pool:
        return pool.apply(_noticed, (recorded, file, wanted))


def _noticed(recorded: list[Recorded], file: Path, mutants: Sequence[Mutant]) -> dict[str, bool]:
    materials = judging.load(recorded)
    assert not any(judging.fails(material) for material in materials)
    judging.forget()
    lines = judging.touched(materials, [file])

    def job(mutant: Mutant) -> judging.Job:
        names = judging.who_runs(mutant, lines)
        return judging.Job(mutant, lambda: any(judging.fails(each) for each in materials if each.name in names))

    return {mutant.change: observed for mutant, observed in judging.in_children(map(job, mutants), at_once=2)}


def test_a_case_notices_that_its_diagnosis_was_taken_out(recorded: list[Recorded]) -> None:
    found = noticed(recorded, WHY, 'return Cause("no-slash", f"The full')
    assert all(found.values()), found


def test_of_those_that_see_a_file_alike_three_are_requested(tmp_path: Path) -> None:
    file = tmp_path / "a.py"
    mutant = Mutant(file, 3, 3, DETAIL, "", "")
    deep, flat = {"a", "b", "c", "d", "e"}, {"f"}
    lines = {(file, 1): {*deep, *flat, "g"}, (file, 3): {*deep, *flat}, (file, 4): deep, (tmp_path / "b.py", 1): {"a"}}
    assert judging.requested(mutant, lines, 3) == ["a", "b", "c", "f"]
    assert judging.requested(replace(mutant, at_import=True), lines, 3) == ["a", "b", "c", "d", "e", "f", "g"]


def test_a_mutant_that_no_case_runs_survives(recorded: list[Recorded]) -> None:
    found = noticed(recorded, ANSWERS, '"no-answers" ->')
    assert not any(found.values()), found


@pytest.mark.exhaustive
def test_every_known_mutant_is_there() -> None:
    known = equivalent.read()
    files = [file for each in known for file in (ROOT / "grader" / "checks").rglob(each.file)]
    assert len(files) == len(known)
    files = sorted(set(files))
    mutants = [mutant for file in files for mutant in mutants_of(file)]
    assert [each for each in known if not any(equivalent.is_known(mutant, [each]) for mutant in mutants)] == []
