"""The calls of a trial without a simulator in exercise.toml."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from grader.errors import UsageError
from grader.exercise.call_inputs import Arc, CallsSpec, PointsInput
from grader.exercise.calls_toml import unknown_calls
from grader.exercise.model import CheckSpec, catalogue
from grader.exercise.scenario_toml import read_trials
from grader.exercise.tables import Table
from grader.tests.exercise.test_exercise_toml import load

if TYPE_CHECKING:
    from pathlib import Path

FIT: dict[str, Any] = {
    "id": "fit",
    "function": "p.module:f",
    "points": [
        {"id": "arc", "x_m": 1.0, "y_m": 2.0, "radius_m": 0.5, "to_deg": 90.0, "count": 10, "noise_m": 0.1},
        {"id": "two", "x": [1, 2.5], "y": [3, 4], "lists": True},
    ],
}
BAG = {"id": "slow", "x_m": 1.0, "y_m": 2.0, "radius_m": 0.5, "count": 10, "rate_hz": 2.0}


def read(trial: dict[str, Any]) -> tuple[CallsSpec, list[str]]:
    problems: list[str] = []
    (spec,) = read_trials(Table({"trial": [trial]}, "", problems), "p")
    return spec.calls, problems


def test_a_function_is_called_with_an_arc_and_with_points() -> None:
    calls, problems = read(FIT)
    assert problems == []
    assert (calls.function, calls.ids) == ("p.module:f", ("arc", "two"))
    assert calls.points == (
        PointsInput("arc", Arc(1.0, 2.0, 0.5, 0.0, 90.0, 10, 0.1)),
        PointsInput("two", None, (1.0, 2.5), (3.0, 4.0), lists=True),
    )


def test_a_program_is_started_with_a_bag() -> None:
    calls, problems = read({"id": "report", "executable": "report", "bag": [BAG]})
    assert problems == []
    assert (calls.function, calls.bags[0].rate_hz, calls.bags[0].poses) == ("", 2.0, True)


@pytest.mark.parametrize(
    ("trial", "part"),
    [
        ({**FIT, "function": "f"}, "function"),
        ({**FIT, "points": []}, "needs [[trial.points]]"),
        ({**FIT, "points": [FIT["points"][0]] * 2}, 'the id "arc" is used more than once'),
        ({**FIT, "points": [{"id": "x", "x": [1], "y": ["a"]}]}, '"y" is'),
        ({**FIT, "points": [{**FIT["points"][0], "radius_m": -1}]}, "radius_m"),
        ({**FIT, "points": [{**FIT["points"][0], "count": 20.5}]}, '"count" is 20.5; it must be a whole number from 0'),
        ({**FIT, "duration_s": 5.0}, "duration_s"),
        ({"id": "report", "bag": [BAG]}, "executable"),
        ({"id": "report", "executable": "report", "bag": [{**BAG, "rate_hz": 0}]}, "rate_hz"),
        ({"id": "report", "executable": "report", "bag": [{**BAG, "rate": 1}]}, 'unknown key "rate"'),
    ],
)
def test_a_mistake_is_told_to_the_author(trial: dict[str, Any], part: str) -> None:
    _, problems = read(trial)
    assert any(part in problem for problem in problems), problems


def test_a_check_names_a_call_of_its_trial(tmp_path: Path) -> None:
    text = catalogue()["11-bags"].read_text("utf-8")
    with pytest.raises(UsageError) as refused:
        load(tmp_path, text.replace('call = "arc"', 'call = "ark"'))
    assert '[[check]] (arc): "call" is "ark"; the trial fit has the calls whole, noise, arc' in str(refused.value)


def test_a_single_call_is_in_the_singular() -> None:
    (trial,) = read_trials(Table({"trial": [{**FIT, "points": FIT["points"][:1]}]}, "", []), "p")
    check = CheckSpec("x", "fits_circle", "", 1.0, (), hidden=False, params={"call": "ark"}, trial="fit")
    assert [*unknown_calls([trial], [check])] == ['[[check]] (x): "call" is "ark"; the trial fit has the call arc.']
