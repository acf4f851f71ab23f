"""In a class with attacks, honest submissions get the same reports as without attacks, and the command exits with 0."""

from __future__ import annotations

import os
import shutil
import subprocess
from typing import TYPE_CHECKING

import pytest

from grader.sandbox import bubblewrap
from grader.tests.attack import Attack, make_attack, read_attacks
from grader.tests.case import CASES, copy_solution, make_submission, read_case
from grader.tests.classroom.a_class import GRADER, STEP, environment, judged, reports

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="the sandbox is not available")
CLASS = 40
HONEST = (
    "solution",
    "unusual/301-functions-and-a-closure",
    "unusual/303-inheritance-and-relative-imports",
    "unusual/302-callback-groups",
    "mistakes/306-missing-depend",
    "mistakes/323-other-topic",
    "mistakes/329-one-hertz",
    "mistakes/332-clockwise",
)
"""The submissions of the honest students: our solution, or a case."""
ATTACKS = tuple(attack for attack in read_attacks() if attack.base == STEP)
SAMPLE = tuple(attack for attack in ATTACKS if attack.sample)[:4]
EACH = CLASS - len(HONEST)


def make_honest(folder: Path, names: tuple[str, ...]) -> Path:
    """Write the honest submissions below the new folder."""
    for number, name in enumerate(names):
        to = folder / f"honest-{number}"
        if name == "solution":
            copy_solution(STEP, to / "my_robot_controller")
        else:
            make_submission(read_case(CASES.parent / name), to)
    return folder


def is_crowded_by_others(out: Path) -> bool:
    """Return whether other programs keep this machine busy and are the reason for every error in the reports."""
    outcomes = [outcome for report in reports(out).values() for outcome in report["outcomes"]]
    errors = [str(outcome) for outcome in outcomes if outcome["status"] == "error"]
    return os.getloadavg()[0] > 2.0 * (os.cpu_count() or 1) and all(
        "The machine was too busy" in each for each in errors
    )


def graded(folder: Path, out: Path) -> Path:
    """Grade a class. The command must exit with 0."""
    command = [GRADER, "grade", str(folder), "--exercise", STEP, "--out", str(out)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment())
    expected = (0, 3) if is_crowded_by_others(out) else (0,)
    assert done.returncode in expected, done.stdout + done.stderr
    return out


def assert_untouched(tmp_path: Path, honest: tuple[str, ...], attacks: tuple[Attack, ...]) -> None:
    alone = graded(make_honest(tmp_path / "alone", honest), tmp_path / "reports-alone")
    shutil.copytree(tmp_path / "alone", tmp_path / "class")
    for attack in attacks:
        make_attack(attack, tmp_path / "class" / attack.name)
    together = graded(tmp_path / "class", tmp_path / "reports")
    expected, judgements = judged(alone), judged(together)
    assert judgements.keys() == expected.keys() | {attack.name for attack in attacks}
    assert {student: judgements[student] for student in expected} == expected
    points = {student: report["points"] for student, report in reports(together).items()}
    assert [attack.name for attack in attacks if points[attack.name] > attack.most] == []


def test_a_class_with_some_attacks(tmp_path: Path) -> None:
    assert_untouched(tmp_path, HONEST[:3], SAMPLE)


@pytest.mark.exhaustive
@pytest.mark.parametrize("first", range(0, len(ATTACKS), EACH))
def test_a_class_of_forty_with_every_attack(first: int, tmp_path: Path) -> None:
    """The last class is filled up with the first attacks, so that each class has forty submissions."""
    attacks = (*ATTACKS, *ATTACKS)[first : first + EACH]
    assert len(attacks) + len(HONEST) == CLASS
    assert_untouched(tmp_path, HONEST, attacks)
