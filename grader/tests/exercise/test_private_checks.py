"""An instructor's private checks: they are merged with the course's checks and hidden from students."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import exercise_from, load_exercise
from grader.errors import UsageError
from grader.exercise.model import catalogue
from grader.exercise.private_checks import Sources, sources_of
from grader.sandbox import bubblewrap
from grader.tests.case import copy_solution
from grader.tests.classroom.a_class import STEP, grade, reports, rows

if TYPE_CHECKING:
    from pathlib import Path

    from grader.exercise.model import Exercise

PUBLIC = catalogue()[STEP]
SECRET = "The circle is driven exactly twice"
PRIVATE = f"""
schema = 2

[[trial]]
id = "circle"
duration_s = 9.5

[[check]]
id = "rate"
points = 30
rate_hz = 3.0

[[check]]
id = "secret-radius"
kind = "circle"
title = "{SECRET}"
points = 7
needs = ["topic"]
radius_m = 3.217
turns = 1.0

[[check]]
id = "open"
kind = "builds"
title = "It builds, seen by all"
points = 1
hidden = false
"""


def merged(private: str) -> Exercise:
    data = private.encode("utf-8", "surrogateescape")
    return exercise_from(Sources(STEP, PUBLIC.read_bytes(), data, "mine/exercise.toml"))


def test_the_same_id_replaces_and_a_new_one_is_added() -> None:
    public, both = load_exercise(PUBLIC), merged(PRIVATE)
    before = {check.id: check for check in public.checks}
    after = {check.id: check for check in both.checks}
    assert after.keys() - before.keys() == {"secret-radius", "open"}
    assert (after["rate"].points, after["rate"].params["rate_hz"]) == (30.0, 3.0)
    assert after["rate"].params["tolerance_percent"] == before["rate"].params["tolerance_percent"]
    assert (after["rate"].title, after["rate"].needs) == (before["rate"].title, before["rate"].needs)
    assert {id_: after[id_] for id_ in before if id_ != "rate"} == {id_: before[id_] for id_ in before if id_ != "rate"}
    assert [each.trials[0].scenario.duration_s for each in (public, both)] == [10.0, 9.5]


def test_private_checks_are_hidden_unless_they_are_declared_visible() -> None:
    hidden = {check.id for check in merged(PRIVATE).checks if check.hidden}
    assert hidden == {"rate", "secret-radius"}


@pytest.mark.parametrize(
    ("keys", "hidden"),
    [
        ("points = 40", False),
        ('points = 40\ntitle = "Mine"\nneeds = ["start"]', False),
        ('kind = "rate"\nrate_hz = 2.0', False),  # as in the course
        ("points = 40\nhidden = true", True),
        ("rate_hz = 3.0", True),  # the number may be secret
        ("rate_hz = 3.0\nhidden = false", False),
        ('kind = "builds"\npoints = 2', True),
    ],
)
def test_a_check_that_judges_the_same_as_before_stays_visible(keys: str, hidden: bool) -> None:
    checks = {check.id: check for check in merged(f'schema = 2\n[[check]]\nid = "rate"\n{keys}').checks}
    assert {check.id for check in checks.values() if check.hidden} == ({"rate"} if hidden else set())


def test_both_files_are_part_of_the_digest() -> None:
    digests = {load_exercise(PUBLIC).digest, merged(PRIVATE).digest, merged(PRIVATE + "\n").digest}
    assert len(digests) == 3


@pytest.mark.parametrize(
    ("private", "said"),
    [
        ("schema = 3", "schema is 3"),
        ("[[check]]\nid = 'rate'\npoints = 1", "schema is missing"),
        ("schema = 1\n[scenario]\nduration_s = 9", "schema 1 is no longer supported: move"),
        ("schema = 2\n[exercise]\nid = 'x'", 'unknown key "exercise"'),
        ("schema = 2\n[[check]]\nid = 'x'\nkind = 'circel'\npoints = 1", 'Did you mean "circle"'),
        ("schema = 2\n[[check]]\nid = 'rate'\nrate_hz = 'fast'", '"rate_hz" is "fast"'),
        ("schema = 2\ncheck = 3", "must be an array of tables"),
        ("schema = ", "invalid TOML"),
        ("schema = 2\n# caf\udce9", "line 2 is not UTF-8"),
        ("schema = 2\n[[check]]\npreset = 'node'\npoints = 3", 'unknown key "points"'),
        (
            "schema = 2\n[[check]]\nid = 'rate'\npoints = 1\n[[check]]\nid = 'rate'\npoints = 2",
            'two tables [[check]] have the id "rate"',
        ),
        (
            "schema = 2\n[[trial]]\nid = 'circle'\nduration_s = 1\n[[trial]]\nid = 'circle'\nduration_s = 2",
            'two tables [[trial]] have the id "circle"',
        ),
    ],
)
def test_a_mistake_is_reported_with_the_file(private: str, said: str) -> None:
    with pytest.raises(UsageError) as error:
        merged(private)
    assert said in str(error.value)
    assert "mine/exercise.toml" in str(error.value)


def test_a_byte_order_mark_is_ignored() -> None:
    assert merged(f"\ufeff{PRIVATE}").checks == merged(PRIVATE).checks


def test_a_folder_for_no_exercise_of_ours_is_reported(tmp_path: Path) -> None:
    (tmp_path / "03-circle-publish").mkdir()
    (tmp_path / "03-circle-publish" / "exercise.toml").write_text(PRIVATE)
    with pytest.raises(UsageError, match="Did you mean 03-circle-publisher"):
        sources_of({STEP}, tmp_path)


def test_students_see_only_whether_a_private_check_passed(tmp_path: Path) -> None:
    if not bubblewrap.usable():
        pytest.skip("there is no sandbox here")
    copy_solution(STEP, tmp_path / "class" / "anna")
    (tmp_path / "mine" / STEP).mkdir(parents=True)
    (tmp_path / "mine" / STEP / "exercise.toml").write_text(PRIVATE)
    out = tmp_path / "grades"
    done = grade(tmp_path / "class", "--exercise", STEP, "--out", out, "--checks", tmp_path / "mine", CI="true")
    assert done.returncode == 0, done.stderr
    report = reports(out)["anna"]
    found = {outcome["id"]: (outcome["status"], outcome["hidden"]) for outcome in report["outcomes"]}
    # The instructor sees the failure and the solution's values: 2 Hz and a circle of 2 m.
    assert found["secret-radius"] == ("failed", True)
    assert found["rate"] == ("failed", True)
    assert found["open"] == ("passed", False)
    assert rows(out)[0]["failed"].split() == ["rate", "secret-radius"]
    observed = {
        "page": next((out / "reports").glob("*.html")).read_text("utf-8"),
        "gradescope": next((out / "gradescope").glob("*.json")).read_text("utf-8"),
        **{name: (out / name).read_text("utf-8") for name in ("junit.xml", "github-summary.md")},
        "annotations": (out / "github-annotations.txt").read_text("utf-8"),
        "printed": done.stdout + done.stderr,
    }
    for name, text in observed.items():
        for secret in (SECRET, "secret-radius", "3.217", "3.0 Hz", "wrong-radius"):
            assert secret not in text, f"{secret} is in {name}"
    tests = {test["name"]: test["output"] for test in json.loads(observed["gradescope"])["tests"]}
    assert tests["Hidden check"] == "Hidden check: failed."
    assert "Hidden check" in observed["page"]
