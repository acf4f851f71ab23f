"""Read the `[[trial]]` tables of exercise.toml: the executables and the scenarios."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from grader.common.words import shorten
from grader.exercise.calls_toml import read_calls
from grader.exercise.model import CallInput, Drive, Scenario, StartLimits, TrialSpec
from grader.exercise.tests_toml import read_tests
from grader.turtlesim.services import SERVICES

if TYPE_CHECKING:
    from collections.abc import Mapping

    from grader.exercise.tables import Table

ID = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
ROS_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
NAME = "letters, digits and _, beginning with a letter"
REMAP = re.compile(r"(/\w+)+:=(/\w+)+")
SERVICE = re.compile(r"(/\w+)+")
SERVICE_TYPE = re.compile(r"[a-z][a-z0-9_]*/srv/[A-Z][A-Za-z0-9]*")
CATCH = "/catch"
"""The service of the node that announces the targets (grader/trial/target_keeper.py)."""
PARAMETER_TYPES = (
    (bool, 1, "bool_value"),
    (int, 2, "integer_value"),
    (float, 3, "double_value"),
    (str, 4, "string_value"),
)
"""Tuples: the Python type of a parameter, its number in rcl_interfaces/msg/ParameterType, and the message field for its
value."""
CALLS = ("function", "points", "bag")
"""A `[[trial]]` with one of these keys has no simulator: the grader calls a function or a program."""
MAX_DURATION_S = 600.0
MOST_TARGETS = 5
"""The maximum number of targets. For more targets, target_places.py may find no places for which the nearest-first
order is unambiguous."""
FEWEST_TO_WITHDRAW = 3
"""The minimum number of targets if the trial withdraws one of them."""
FIELD_M = 11.0
"""The largest coordinate of a start pose (m)."""
MAX_SPEED = 10.0
"""The maximum speed (m/s, rad/s)."""


def read_trials(top: Table, package: str) -> tuple[TrialSpec, ...]:
    """Return the trials. Mistakes are recorded in the tables that contain them."""
    tables = top.tables("trial")
    if not tables:
        top.problem("there is no [[trial]], so nothing would run.")
    trials = tuple(_trial(table, package) for table in tables)
    trials = tuple(_with_scenario(table, trial, trials) for table, trial in zip(tables, trials, strict=True))
    for table, trial in zip(tables, trials, strict=True):
        if [each.id for each in trials].count(trial.id) > 1:
            table.problem(f'the id "{trial.id}" is used more than once; each trial needs its own id.')
    return trials


def _trial(table: Table, package: str) -> TrialSpec:
    id_ = table.string("id", ID, "lowercase letters, digits and single hyphens, as in figure-eight")
    if id_:
        table.place += f" ({id_})"
    if "tests" in table.values:
        spec = _tests(table, id_)
    else:
        spec = _calls(table, id_) if any(key in table.values for key in CALLS) else _run(table, id_, package)
    table.finish()
    return spec


def _with_scenario(table: Table, trial: TrialSpec, trials: tuple[TrialSpec, ...]) -> TrialSpec:
    """Return the trial. If the key `beside` is the id of another trial, the trial has the scenario of that trial."""
    if not trial.beside:
        return trial
    ids = [each.id for each in trials if each.node and not each.beside and each.tests is None]
    if trial.beside not in ids:
        table.problem(f'"beside" is "{shorten(trial.beside)}"; it must be the id of a trial with a node of its own.')
        return trial
    return replace(trial, scenario=next(each.scenario for each in trials if each.id == trial.beside))


def _run(table: Table, id_: str, package: str) -> TrialSpec:
    if "beside" in table.values:
        executable, node = table.string("executable", ROS_NAME, NAME), table.string("node", ROS_NAME, NAME)
        return TrialSpec(id_, executable, node, Scenario(0.0), beside=table.string("beside"))
    return TrialSpec(
        id=id_,
        executable=table.string("executable", ROS_NAME, NAME) if package else "",
        node=table.string("node", ROS_NAME, NAME) if package else "",
        scenario=_scenario(table, f"/{table.values.get('node')}"),
    )


def _calls(table: Table, id_: str) -> TrialSpec:
    """Return a trial without a simulator, in which a function or the executable is called."""
    calls = read_calls(table)
    executable = table.string("executable", ROS_NAME, NAME) if calls.bags else ""
    return TrialSpec(id_, executable, "", Scenario(0.0), calls)


def _tests(table: Table, id_: str) -> TrialSpec:
    """Return a trial without a simulator, in which the student's tests run."""
    executable, node = table.string("executable", ROS_NAME, NAME), table.string("node", ROS_NAME, NAME)
    return TrialSpec(id_, executable, node, Scenario(0.0), tests=read_tests(table))


def _scenario(table: Table, node: str) -> Scenario:
    rename = table.strings("rename")
    targets = table.whole("targets", 0, MOST_TARGETS, default=0)
    own = _own_services(rename, targets)
    start = table.string("start", re.compile("turtlesim|anywhere"), '"turtlesim" or "anywhere"', default="turtlesim")
    scenario = Scenario(
        duration_s=table.number("duration_s", 0.1, MAX_DURATION_S, f"from 0.1 to {MAX_DURATION_S:g} (s)"),
        drives=tuple(_drive(each) for each in table.tables("drive")),
        anywhere=start == "anywhere",
        start_limits=_start_limits(table.table("start_pose")) if "start_pose" in table.values else None,
        rename=rename,
        pose_every=table.whole("pose_every", 1, 1000, default=1),
        pose_from_s=table.number("pose_from_s", 0.0, MAX_DURATION_S, f"from 0 to {MAX_DURATION_S:g} (s)", default=0.0),
        answers_after_s=table.number("answers_after_s", 0.0, 10.0, "from 0 to 10 (s)", default=0.0),
        calls=tuple(_call(each, own) for each in table.tables("call"))
        + tuple(_set(each, node) for each in table.tables("set")),
        parameters=table.settings("parameters"),
        params_file=table.settings("params_file"),
        alone_s=table.number("alone_s", 0.1, MAX_DURATION_S, f"from 0.1 to {MAX_DURATION_S:g} (s)")
        if "alone_s" in table.values
        else None,
        targets=targets,
        withdraws=table.flag("withdraws"),
        catch_from_s=table.number(
            "catch_from_s", 0.0, MAX_DURATION_S, f"from 0 to {MAX_DURATION_S:g} (s)", default=0.0
        ),
    )
    if scenario.withdraws and scenario.targets < FEWEST_TO_WITHDRAW:
        table.problem(f'"withdraws" needs "targets" to be at least {FEWEST_TO_WITHDRAW}.')
    for rule in scenario.rename:
        if not REMAP.fullmatch(rule):
            table.problem(f'"rename" contains "{shorten(rule)}"; a rule has the form "/old/name:=/new/name".')
    return scenario


def _start_limits(table: Table) -> StartLimits:
    x_m, y_m = (table.limits(key, 0.0, FIELD_M) for key in ("x_m", "y_m"))
    limits = StartLimits(x_m, y_m, table.limits("theta_rad", -math.pi, math.pi))
    table.finish()
    return limits


def _drive(table: Table) -> Drive:
    drive = Drive(
        table.number("from_s", 0.0, MAX_DURATION_S, f"from 0 to {MAX_DURATION_S:g} (s)"),
        table.limits("linear_x_m_s", -MAX_SPEED, MAX_SPEED),
        table.limits("angular_z_rad_s", -MAX_SPEED, MAX_SPEED),
    )
    table.finish()
    return drive


def _own_services(rename: tuple[str, ...], targets: int) -> dict[str, str]:
    """Return the services of the grader's own nodes. Each name is mapped to a phrase for the node that offers it."""
    renamed = dict(rule.split(":=", 1) for rule in reversed(rename) if REMAP.fullmatch(rule))
    services = {renamed.get(name, name): "the simulator" for name in SERVICES}
    return {**services, CATCH: "the node that announces the targets"} if targets else services


def _call(table: Table, own: Mapping[str, str]) -> CallInput:
    call = CallInput(
        table.number("at_s", 0.0, MAX_DURATION_S, f"from 0 to {MAX_DURATION_S:g} (s)"),
        table.string("service", SERVICE, "a full name, such as /pause"),
        table.string("type", SERVICE_TYPE, "a service type, such as std_srvs/srv/SetBool"),
        table.anything("request"),
    )
    if call.service in own:
        whose = own[call.service]
        table.problem(f'"service" is "{call.service}", a service of {whose}; it must be a service of the node.')
    table.finish()
    return call


def _set(table: Table, node: str) -> CallInput:
    """Return the service call that sets one or more parameters of the node. Several parameters are set atomically."""
    at_s = table.number("at_s", 0.0, MAX_DURATION_S, f"from 0 to {MAX_DURATION_S:g} (s)")
    first = _parameter(table.string("parameter"), table.setting("value"))
    others = [_parameter(name, value) for name, value in table.settings("also").items()]
    table.finish()
    if others:
        service, type_ = f"{node}/set_parameters_atomically", "rcl_interfaces/srv/SetParametersAtomically"
    else:
        service, type_ = f"{node}/set_parameters", "rcl_interfaces/srv/SetParameters"
    return CallInput(at_s, service, type_, {"parameters": [first, *others]})


def _parameter(name: str, value: object) -> dict[str, Any]:
    """Return a parameter as the fields of rcl_interfaces/msg/Parameter."""
    number, field = next(row[1:] for row in PARAMETER_TYPES if type(value) is row[0])
    return {"name": name, "value": {"type": number, field: value}}
