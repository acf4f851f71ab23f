from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import load_exercise
from grader.errors import UsageError
from grader.exercise.model import Drive, Exercise, Hint, Scenario, TrialSpec, catalogue

if TYPE_CHECKING:
    from pathlib import Path

GOOD = """\
schema = 2

[exercise]
id = "99-test"
title = "A test"
package = "my_package"

[[trial]]
id = "drive"
executable = "my_node"
node = "my_node"
duration_s = 5

[[trial]]
id = "stand"
executable = "my_other_node"
node = "other"
duration_s = 3
start = "anywhere"

[[trial.drive]]
from_s = 1
linear_x_m_s = [0.5, 1]
angular_z_rad_s = 0

[[check]]
id = "rate"
kind = "rate"
points = 10
rate_hz = 2
min_interval_s = 0.4
max_interval_s = 0.65

[[check]]
id = "values"
kind = "values"
title = "The values"
points = 5
needs = ["rate"]
hidden = true
linear_x_m_s = 2.0

[[hint]]
text = "Think."
"""


def load(folder: Path, text: str | bytes) -> Exercise:
    file = folder / "exercise.toml"
    file.write_bytes(text.encode() if isinstance(text, str) else text)
    return load_exercise(file)


def problems(folder: Path, text: str | bytes) -> list[str]:
    with pytest.raises(UsageError) as raised:
        load(folder, text)
    prefix = f"{folder / 'exercise.toml'}: "
    lines = str(raised.value).splitlines()
    assert all(line.startswith(prefix) for line in lines)
    return [line.removeprefix(prefix) for line in lines]


def test_what_stands_in_the_file_is_what_the_exercise_says(tmp_path: Path) -> None:
    exercise = load(tmp_path, GOOD)
    assert (exercise.id, exercise.title, exercise.package) == ("99-test", "A test", "my_package")
    drive, stand = exercise.trials
    assert drive == TrialSpec("drive", "my_node", "my_node", Scenario(5.0))
    assert stand == TrialSpec(
        "stand", "my_other_node", "other", Scenario(3.0, (Drive(1.0, (0.5, 1.0), (0.0, 0.0)),), anywhere=True)
    )
    assert exercise.trial("stand") is stand
    assert exercise.hints == (Hint("Think."),)
    assert exercise.folder == tmp_path
    rate, values = exercise.checks
    assert (values.title, values.points, values.needs, values.hidden) == ("The values", 5.0, ("rate",), True)
    assert (rate.title, rate.needs, rate.hidden) == ("Commands arrive at the right rate", (), False)


def test_a_check_judges_the_first_trial_unless_it_names_another(tmp_path: Path) -> None:
    checks = load(tmp_path, GOOD.replace("hidden = true", 'trial = "stand"')).checks
    assert [check.trial for check in checks] == ["drive", "stand"]


def test_an_exercise_without_trials_is_a_mistake(tmp_path: Path) -> None:
    reported = problems(tmp_path, GOOD[: GOOD.index("[[trial]]")] + GOOD[GOOD.index("[[check]]") :])
    assert reported == ["there is no [[trial]], so nothing would run."]


def test_an_exercise_of_answers_alone_has_trials_without_a_node(tmp_path: Path) -> None:
    text = "\n".join(line for line in GOOD.splitlines() if not line.startswith(("package", "executable", "node")))
    assert [(trial.executable, trial.node) for trial in load(tmp_path, text).trials] == [("", ""), ("", "")]


def test_parameters_that_were_left_out_have_their_kinds_defaults(tmp_path: Path) -> None:
    rate, values = load(tmp_path, GOOD).checks
    assert rate.params["tolerance_percent"] == 5.0
    assert values.params["angular_z_rad_s"] == 0.0
    assert values.params["linear_x_m_s"] == 2.0


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("schema = 2", "schema = 3", '"schema" is 3; it must be 2, the version of this format.'),
        ("schema = 2", "schema = 1", "schema 1 is no longer supported: move `executable` and `node` out of [exercise]"),
        ("schema = 2", "", 'the key "schema" is missing; it must be 2, the version of this format.'),
        (
            'id = "99-test"',
            'id = "99 Test"',
            (
                '[exercise]: "id" is "99 Test"; it must be lowercase letters, digits and single hyphens, as in '
                "03-circle-publisher."
            ),
        ),
        ('title = "A test"\n', "", '[exercise]: the key "title" is missing; it must be a string that is not blank.'),
        (
            'title = "A test"',
            'titel = "A test"',
            '[exercise]: unknown key "titel". Did you mean "title"? Allowed: ',
        ),
        (
            'package = "my_package"',
            'package = "my-package"',
            '[exercise]: "package" is "my-package"; it must be letters, digits and _, beginning with a letter.',
        ),
        (
            "duration_s = 5",
            "duration_s = -5",
            '[[trial]] 1 (drive): "duration_s" is -5; it must be from 0.1 to 600 (s).',
        ),
        (
            "duration_s = 5",
            "duration_s = nan",
            '[[trial]] 1 (drive): "duration_s" is nan; it must be from 0.1 to 600 (s).',
        ),
        (
            "duration_s = 5",
            "duration_s = true",
            '[[trial]] 1 (drive): "duration_s" is true; it must be from 0.1 to 600 (s).',
        ),
        ("[[trial]]", "[[trail]]", 'unknown key "trail". Did you mean "trial"?'),
        (
            'id = "stand"',
            'id = "drive"',
            '[[trial]] 1 (drive): the id "drive" is used more than once; each trial needs its own id.',
        ),
        ('node = "other"', "", '[[trial]] 2 (stand): the key "node" is missing; it must be letters, digits and _'),
        (
            "hidden = true",
            'trial = "stood"',
            '[[check]] 2 (values): "trial" is "stood"; it must be the id of a [[trial]]: drive',
        ),
        ('kind = "rate"', 'kind = "rates"', '[[check]] 1 (rate): unknown kind "rates". Did you mean "rate"?'),
        ("points = 10", 'points = "10"', '[[check]] 1 (rate): "points" is "10"; it must be a number from 0 to 1000.'),
        (
            "rate_hz = 2",
            "rate_hz = 0",
            '[[check]] 1 (rate): "rate_hz" is 0; it must be a number above 0 and at most 1000.',
        ),
        (
            "rate_hz = 2",
            "rate_hz = inf",
            '[[check]] 1 (rate): "rate_hz" is inf; it must be a number above 0 and at most 1000.',
        ),
        (
            "rate_hz = 2",
            "",
            (
                '[[check]] 1 (rate): the key "rate_hz" is missing; the kind "rate" needs it: a number above 0 and at '
                "most 1000."
            ),
        ),
        (
            "rate_hz = 2",
            "rate_hz = 2\nrate_khz = 1",
            '[[check]] 1 (rate): unknown key "rate_khz". Did you mean "rate_hz"?',
        ),
        (
            'needs = ["rate"]',
            'needs = ["rat"]',
            (
                '[[check]] 2 (values): "needs" contains "rat", which is not a check. Did you mean "rate"? Allowed: '
                "rate, values."
            ),
        ),
        (
            'needs = ["rate"]',
            'needs = "rate"',
            '[[check]] 2 (values): "needs" is "rate"; it must be a list of strings.',
        ),
        ("[[trial]]", 'starting_point_fails = ["rat"]\n[[trial]]', '[exercise]: "starting_point_fails" contains "rat"'),
        ('needs = ["rate"]', 'needs = ["values"]', '"needs" has a cycle: values -> values. Remove one of these needs.'),
        (
            'id = "values"',
            'id = "rate"',
            '[[check]] 1 (rate): the id "rate" is used 2 times; each check needs its own id.',
        ),
        ("hidden = true", 'hidden = "yes"', '[[check]] 2 (values): "hidden" is "yes"; it must be true or false.'),
        ('text = "Think."', 'text = " "', '[[hint]] 1: "text" is " "; it must be a string that is not blank.'),
        (
            'text = "Think."',
            'text = "Think."\nfor = "rate"',
            '[[hint]] 1: unknown key "for". Allowed: text, checks, part.',
        ),
        (
            'text = "Think."',
            'text = "Think."\npart = "a)"',
            '[[hint]] 1: "part" is "a)"; it must be a letter, as in "d".',
        ),
        (
            'text = "Think."',
            'text = "Think."\nchecks = ["rat"]',
            '[[hint]] 1: "checks" contains "rat", which is not a check. Did you mean "rate"? Allowed: rate, values.',
        ),
        ("[[hint]]", "[hint]", '"hint" is a table; it must be an array of tables, [[hint]].'),
    ],
)
def test_each_mistake_of_an_author_is_named(tmp_path: Path, old: str, new: str, expected: str) -> None:
    assert old in GOOD
    reported = problems(tmp_path, GOOD.replace(old, new, 1))
    assert [line for line in reported if line.startswith(expected)], reported


def test_a_circle_of_needs_is_shown(tmp_path: Path) -> None:
    reported = problems(tmp_path, GOOD.replace('kind = "rate"', 'kind = "rate"\nneeds = ["values"]'))
    assert reported == ['"needs" has a cycle: rate -> values -> rate. Remove one of these needs.']


def test_all_mistakes_are_reported_at_once(tmp_path: Path) -> None:
    text = GOOD.replace("rate_hz = 2", "rate_hz = 0").replace("duration_s = 5", "").replace('"my_node"', "3", 1)
    assert len(problems(tmp_path, text)) == 3


def test_advice_is_worth_nothing(tmp_path: Path) -> None:
    text = GOOD + '\n[[check]]\nid = "timer"\nkind = "uses_timer"\npoints = 1\n'
    assert problems(tmp_path, text) == [
        '[[check]] 3 (timer): "points" is 1; the kind "uses_timer" is advice, which is worth 0.'
    ]


def test_an_exercise_without_checks_is_a_mistake(tmp_path: Path) -> None:
    reported = problems(tmp_path, GOOD[: GOOD.index("[[check]]")])
    assert reported == ["there is no [[check]], so nothing would be judged."]


@pytest.mark.parametrize("data", [b"schema = ", b"\xff\xfe", b'schema = 2\n[exercise]\nid = "a"\nid = "b"'])
def test_what_is_not_toml_is_reported(tmp_path: Path, data: bytes) -> None:
    (reported,) = problems(tmp_path, data)
    assert reported.startswith("invalid TOML: ")


def test_a_file_that_is_not_there_is_reported(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="cannot be read"):
        load_exercise(tmp_path)


def test_the_digest_changes_with_the_file(tmp_path: Path) -> None:
    before = load(tmp_path, GOOD).digest
    assert load(tmp_path, GOOD).digest == before
    assert load(tmp_path, GOOD.replace("rate_hz = 2", "rate_hz = 3")).digest != before


def test_every_exercise_of_the_course_is_valid_and_named_as_its_folder() -> None:
    files = catalogue()
    assert "03-circle-publisher" in files
    for id_, file in files.items():
        exercise = load_exercise(file)
        assert exercise.id == id_
        assert sum(check.points for check in exercise.checks) == 100


BESIDE = GOOD.replace(
    "[[check]]", '[[trial]]\nid = "more"\nexecutable = "b"\nnode = "b"\nbeside = "drive"\n\n[[check]]', 1
)


def test_a_node_beside_another_one_has_the_same_scenario(tmp_path: Path) -> None:
    exercise = load(tmp_path, BESIDE)
    assert exercise.beside("drive") == (exercise.trial("more"),)
    assert exercise.trial("more") == TrialSpec("more", "b", "b", exercise.trial("drive").scenario, beside="drive")


@pytest.mark.parametrize("name", ["more", "nowhere"])
def test_a_node_must_be_beside_a_trial_with_a_node_of_its_own(tmp_path: Path, name: str) -> None:
    (reported,) = problems(tmp_path, BESIDE.replace('beside = "drive"', f'beside = "{name}"'))
    assert reported == f'[[trial]] 3 (more): "beside" is "{name}"; it must be the id of a trial with a node of its own.'
