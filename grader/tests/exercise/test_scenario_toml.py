"""The scenario in exercise.toml: the inputs and events of a trial."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import pytest

from grader.exercise.model import StartLimits
from grader.exercise.scenario_toml import read_trials
from grader.exercise.tables import Table
from grader.trial.inputs import Inputs, draw_inputs
from grader.trial.recording import Pose

if TYPE_CHECKING:
    from grader.exercise.model import Scenario

TRIAL = {"id": "circle", "executable": "draw", "node": "draw", "duration_s": 5.0}
CALL = {"at_s": 1.0, "service": "/pause", "type": "std_srvs/srv/SetBool", "request": {"data": True}}


def read(**more: Any) -> tuple[Scenario, list[str]]:  # noqa: ANN401 - TOML
    problems: list[str] = []
    trials = read_trials(Table({"trial": [{**TRIAL, **more}]}, "", problems), "my_package")
    return trials[0].scenario, problems


def test_a_trial_may_call_a_service_and_set_a_parameter() -> None:
    scenario, problems = read(call=[CALL], set=[{"at_s": 2.0, "parameter": "radius", "value": -1.0}])
    assert problems == []
    pause, radius = scenario.calls
    assert (pause.at_s, pause.service, pause.type, pause.request) == tuple(CALL.values())
    assert (radius.at_s, radius.service) == (2.0, "/draw/set_parameters")
    value = {"name": "radius", "value": {"type": 3, "double_value": -1.0}}
    assert radius.request == {"parameters": [value]}


def test_a_trial_may_set_several_parameters_at_once() -> None:
    scenario, problems = read(set=[{"at_s": 2.0, "parameter": "radius", "value": 0.5, "also": {"speed": 2.0}}])
    assert problems == []
    assert scenario.calls[0].service == "/draw/set_parameters_atomically"
    assert [each["name"] for each in scenario.calls[0].request["parameters"]] == ["radius", "speed"]


@pytest.mark.parametrize(
    ("value", "number", "field"),
    [
        (True, 1, "bool_value"),
        (False, 1, "bool_value"),
        (2, 2, "integer_value"),
        (0, 2, "integer_value"),
        (0.0, 3, "double_value"),
        ("a", 4, "string_value"),
        ("", 4, "string_value"),
    ],
)
def test_a_parameter_has_the_type_of_its_value(value: object, number: int, field: str) -> None:
    scenario, _ = read(set=[{"at_s": 2.0, "parameter": "radius", "value": value}])
    given = scenario.calls[0].request["parameters"][0]["value"]
    assert (given, type(given[field])) == ({"type": number, field: value}, type(value))


def test_the_parameters_at_the_start_are_ros_arguments_and_a_file() -> None:
    scenario, problems = read(parameters={"radius": 2.0}, params_file={"speed": 1.5}, call=[CALL])
    assert problems == []
    inputs = draw_inputs(scenario, Pose(5.5, 5.5, 0.0), 1)
    assert inputs.arguments == ("-p", "radius:=2.0")
    assert '"/**"' in inputs.params_file
    assert '"speed": 1.5' in inputs.params_file
    assert Inputs.from_json(asdict(inputs)) == inputs


def test_a_trial_may_limit_its_start_pose_and_withdraw_a_target() -> None:
    limits = {"x_m": [4.5, 7.5], "y_m": 6.0, "theta_rad": [2.8, 3.1]}
    scenario, problems = read(start_pose=limits, targets=3, withdraws=True, catch_from_s=4.0)
    assert problems == []
    assert scenario.start_limits == StartLimits((4.5, 7.5), (6.0, 6.0), (2.8, 3.1))
    inputs = draw_inputs(scenario, Pose(5.5, 5.5, 0.0), 1)
    assert inputs.catch_from_s == 4.0
    assert len(inputs.withdrawn) == 2
    assert Inputs.from_json(asdict(inputs)) == inputs


@pytest.mark.parametrize(
    ("more", "key"),
    [
        ({"targets": 2, "withdraws": True}, "withdraws"),
        ({"start_pose": {"x_m": 1.0, "y_m": 2.0}}, "theta_rad"),
        ({"start_pose": {"x_m": -1.0, "y_m": 2.0, "theta_rad": -1.0}}, "x_m"),
        ({"start_pose": {"x_m": 1.0, "y_m": [-0.1, 2.0], "theta_rad": 0.0}}, "y_m"),
        ({"call": [{**CALL, "service": "pause"}]}, "service"),
        ({"call": [{**CALL, "type": "std_srvs/SetBool"}]}, "type"),
        ({"call": [{**CALL, "at_s": -1.0}]}, "at_s"),
        ({"call": [{**CALL, "request": 3}]}, "request"),
        ({"call": [{**CALL, "answer": 3}]}, "answer"),
        ({"set": [{"at_s": 2.0, "parameter": "radius"}]}, "value"),
        ({"parameters": {"radius": []}}, "parameters"),
        ({"pose_every": 2.5}, "pose_every"),
        ({"targets": True}, "targets"),
    ],
)
def test_a_wrong_key_is_named(more: dict[str, Any], key: str) -> None:
    assert any(f'"{key}"' in problem for problem in read(**more)[1])


@pytest.mark.parametrize(
    ("service", "more", "whose"),
    [
        ("/spawn", {}, "the simulator"),
        ("/turtle1/set_pen", {}, "the simulator"),
        ("/turtlesim/set_parameters", {}, "the simulator"),
        ("/where", {"rename": ["/spawn:=/where"]}, "the simulator"),
        ("/catch", {"targets": 1}, "the node that announces the targets"),
        ("/spawn", {"rename": ["/spawn:=/where"]}, None),
        ("/catch", {}, None),
        ("/draw/set_parameters", {}, None),
        ("/turtle1/pause", {}, None),
    ],
)
def test_a_trial_calls_only_services_of_the_node(service: str, more: dict[str, Any], whose: str | None) -> None:
    problems = read(call=[{**CALL, "service": service}], **more)[1]
    told = f'"service" is "{service}", a service of {whose}; it must be a service of the node.'
    assert [problem.partition(": ")[2] for problem in problems] == ([] if whose is None else [told])
