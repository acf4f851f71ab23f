"""In a class with attacks, honest submissions get the same reports as without attacks, and the command exits with 0."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.ros import installation, underlay
from grader.sandbox import bubblewrap
from grader.tests.attack import Attack, make_attack, read_attacks
from grader.tests.case import CASES, copy_solution, make_submission, read_case
from grader.tests.classroom.a_class import GRADER, STEP, environment, judged, reports
from grader.tests.observed_host import USER, readable_by_others

if TYPE_CHECKING:
    from collections.abc import Iterator

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
HONEST_OF = {"12-tests": ("solution", "mistakes/1206-functions-not-named-test")}
"""The honest submissions for another step, if they are not only our solution."""
ATTACKS = read_attacks()
CIRCLES = tuple(attack for attack in ATTACKS if attack.base == STEP)
SAMPLE = tuple(attack for attack in CIRCLES if attack.sample)[:4]
EACH = CLASS - len(HONEST)
OTHERS = tuple(dict.fromkeys(attack.base for attack in ATTACKS if attack.base != STEP))
"""The other steps that an attack is made for."""


@dataclass(frozen=True)
class Class:
    """Honest submissions and attacks for one step, and the folder for the class and its results."""

    folder: Path
    step: str = STEP
    honest: tuple[str, ...] = HONEST
    as_user: bool = False


def make_honest(folder: Path, step: str, names: tuple[str, ...]) -> Path:
    """Write the honest submissions below the new folder."""
    for number, name in enumerate(names):
        to = folder / f"honest-{number}"
        if name == "solution":
            copy_solution(step, to / "my_robot_controller")
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


def graded(one: Class, name: str) -> Path:
    """Grade a class. The command must exit with 0, or, on a crowded machine, with 0 or 3."""
    out = one.folder / f"reports-{name}"
    command = [GRADER, "grade", str(one.folder / name), "--exercise", one.step, "--out", str(out)]
    env = environment()
    if one.as_user:
        env |= {"HOME": str(one.folder), "XDG_CACHE_HOME": str(one.folder / "cache")}
        subprocess.run(["chown", "-R", f"{USER}:{USER}", str(one.folder)], check=True)
        command = ["setpriv", f"--reuid={USER}", f"--regid={USER}", "--clear-groups", "--inh-caps=-all", "--", *command]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=env, cwd=one.folder)
    expected = (0, 3) if is_crowded_by_others(out) else (0,)
    assert done.returncode in expected, done.stdout + done.stderr
    return out


def assert_untouched(one: Class, attacks: tuple[Attack, ...]) -> None:
    if one.as_user and (interfaces := underlay.ensure(installation.find_ros())):
        shutil.copytree(interfaces, one.folder / "cache/grader" / interfaces.name, symlinks=True)
    make_honest(one.folder / "alone", one.step, one.honest)
    shutil.copytree(one.folder / "alone", one.folder / "class")
    for attack in attacks:
        make_attack(attack, one.folder / "class" / attack.name)
    alone, together = graded(one, "alone"), graded(one, "class")
    expected, judgements = judged(alone), judged(together)
    assert judgements.keys() == expected.keys() | {attack.name for attack in attacks}
    assert {student: judgements[student] for student in expected} == expected
    points = {student: report["points"] for student, report in reports(together).items()}
    assert [attack.name for attack in attacks if points[attack.name] > attack.most] == []


@pytest.fixture(params=["as the caller", "as an ordinary user"])
def as_user(request: pytest.FixtureRequest) -> bool:
    if request.param == "as the caller":
        return False
    if os.geteuid() != 0:
        pytest.skip("the other tests already run as an ordinary user")
    if not readable_by_others(Path(__file__)):
        pytest.skip("other users cannot read this folder")
    return True


@pytest.fixture
def folder() -> Iterator[Path]:
    """Return a folder that other users can enter, unlike pytest's own folders."""
    with tempfile.TemporaryDirectory(prefix="hostile-class-") as named:
        Path(named).chmod(0o755)
        yield Path(named)


def test_a_class_with_some_attacks(folder: Path) -> None:
    assert_untouched(Class(folder, honest=HONEST[:3]), SAMPLE)


@pytest.mark.exhaustive
@pytest.mark.parametrize("first", range(0, len(CIRCLES), EACH))
def test_a_class_of_forty_with_every_attack(first: int, folder: Path, *, as_user: bool) -> None:
    """The last class is filled up with the first attacks, so that each class has forty submissions."""
    attacks = (*CIRCLES, *CIRCLES)[first : first + EACH]
    assert len(attacks) + len(HONEST) == CLASS
    assert_untouched(Class(folder, as_user=as_user), attacks)


@pytest.mark.exhaustive
@pytest.mark.parametrize("step", OTHERS)
def test_a_class_with_every_attack_on_another_step(step: str, folder: Path, *, as_user: bool) -> None:
    attacks = tuple(attack for attack in ATTACKS if attack.base == step)
    assert_untouched(Class(folder, step, HONEST_OF.get(step, ("solution",)), as_user), attacks)
