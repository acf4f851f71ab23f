from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import pytest

from grader.tests.attack import FOLDER as HOSTILE
from grader.tests.case import CASES, Case, make_submission, read_case, read_cases
from grader.tests.catalogue import MISTAKES

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def cases(tmp_path: Path) -> Path:
    (tmp_path / "cases" / "001-x" / "files").mkdir(parents=True)
    return tmp_path / "cases"


def test_files_are_laid_over_the_solution_without_its_markers(cases: Path, tmp_path: Path) -> None:
    (cases / "001-x" / "files" / "setup.py").write_text("mine")
    (cases / "001-x" / "make.py").write_text("def make(folder):\n    (folder / 'made').touch()\n")
    case = Case("001-x", "", "failed", cases / "001-x", remove=("package.xml", "resource"))
    folder = make_submission(case, tmp_path / "in")
    package = folder / "my_robot_controller"
    assert (package / "setup.py").read_text() == "mine"
    assert (folder / "made").exists()
    assert not (package / "package.xml").exists()
    assert not (package / "resource").exists()
    node = (package / "my_robot_controller" / "draw_circle.py").read_text()
    assert "create_publisher" in node
    assert "SOLUTION" not in node
    assert "TODO" not in node


def test_without_a_base_the_files_are_all_there_is(cases: Path, tmp_path: Path) -> None:
    (cases / "001-x" / "files" / "a.txt").touch()
    folder = make_submission(Case("001-x", "", "usage", cases / "001-x", base=""), tmp_path / "in")
    assert [path.name for path in folder.iterdir()] == ["a.txt"]


@pytest.mark.parametrize("text", ['why = ""\nresult = "fine"\n', 'why = ""\nresult = "failed"\nfailled = ["rate"]\n'])
def test_a_mistake_in_expected_toml_is_an_error(cases: Path, text: str) -> None:
    (cases / "001-x" / "expected.toml").write_text(text)
    with pytest.raises(ValueError, match=r"001-x/expected\.toml"):
        read_case(cases / "001-x")


def test_every_folder_of_cases_is_a_case() -> None:
    assert [case.name for case in read_cases()] == sorted(path.name for path in CASES.iterdir() if path.is_dir())


@pytest.mark.parametrize("below", [CASES, MISTAKES, CASES.parent / "unusual", HOSTILE], ids=lambda below: below.name)
def test_each_case_of_a_folder_has_its_own_number(below: Path) -> None:
    numbers = Counter(path.name.partition("-")[0] for path in below.iterdir() if path.is_dir())
    assert [number for number, amount in numbers.items() if amount > 1 and number.isdigit()] == []
