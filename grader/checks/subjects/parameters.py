"""Checks of parameters: their declarations, and the node's response when the trial sets one."""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_rate import callbacks_of
from grader.checks.causes.why_silent import methods_of
from grader.checks.kind import Kind, choice, number, string, table
from grader.checks.outcome import Finding, failed, passed
from grader.checks.subjects.services import calls_of
from grader.common.words import a_list, shorten
from grader.common.words import number as shown
from grader.submission.constants import evaluate
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.trial.observed import Call

CLOSE = 1e-6
SET = ("/set_parameters", "/set_parameters_atomically")
"""The ends of the names of the services that set parameters: one after the other, or all at once."""
INTEGER, DOUBLE = 2, 3
"""The values of PARAMETER_INTEGER and PARAMETER_DOUBLE in rcl_interfaces/msg/ParameterType."""


UNDECLARED = "undeclared parameter"
NOT_RETURNED = "Callback returned an invalid type"
OTHER_TYPE = "Wrong parameter type"
STEP = "valid step"
READ_ONLY = "Trying to set a read-only parameter"
OUT_OF_RANGE = re.compile(r"Parameter .* out of range|The parameter value for .* valid step")
"""Matches the reason that rclpy gives for a value outside the range.

A reason that fits neither this pattern nor the constants above comes from the student's callback.
"""


@dataclass(frozen=True, kw_only=True)
class Declares:
    """A parameter that is a float, with a description and a range."""

    parameter: str = string("the name of a parameter", about="The name of the parameter.")
    at_least: float = number(about="The smallest value in the range of the parameter.")
    at_most: float = number(about="The largest value in the range of the parameter.")


def declares(evidence: Evidence, params: Declares) -> Finding:
    """When the trial called `describe_parameters`, the node responded with a float, a description and this range."""
    name = params.parameter
    limits = f"{shown(params.at_least)} to {shown(params.at_most)}"
    expected = f"The parameter {name} is a float with a description and the range {limits}."
    where = evidence.place("declare_parameter", "declare_parameters")
    service = f"/{evidence.trial.node}/describe_parameters"
    calls = [each for each in calls_of(evidence) if each.by_trial and each.service == service]
    call = next((each for each in calls if name in each.request.get("names", [name])), None)
    if call is None or call.response is None:
        return _unanswered(evidence, f"The node did not respond when the trial asked for {name}.", expected, where)
    found = _described(call, name)
    if found is None:
        return _undeclared(evidence, name, expected)
    if found["type"] != DOUBLE:
        text = ""
        if found["type"] == INTEGER:
            text = "A default value without a decimal point makes the parameter an integer. Write 2.0 instead of 2."
        observed = f"The parameter {name} is not a float."
        return failed(observed, expected, Cause("parameter-type", text, where))
    if not found["description"].strip():
        text = "A ParameterDescriptor has the fields description and floating_point_range."
        return failed(f"The parameter {name} has no description.", expected, Cause("parameter-descriptor", text, where))
    ranges = [(each["from_value"], each["to_value"]) for each in found["floating_point_range"]]
    if not ranges:
        text = "The field floating_point_range of the ParameterDescriptor is a list with one FloatingPointRange."
        return failed(f"The parameter {name} has no range.", expected, Cause("parameter-descriptor", text, where))
    low, high = ranges[0]
    if abs(low - params.at_least) > CLOSE or abs(high - params.at_most) > CLOSE:
        observed = f"The range of {name} is {shown(low)} to {shown(high)}."
        return failed(observed, expected, Cause("parameter-range", where=where))
    return passed(f"The parameter {name} has a description and the range {limits}.")


@dataclass(frozen=True, kw_only=True)
class SetsParameter:
    """The response of the node when `[[trial.set]]` sets this parameter and perhaps other parameters."""

    parameter: str = string("the name of a parameter", about="The name of the parameter.")
    value: float = number(about="The value that the trial sets.")
    also: tuple[tuple[str, Any], ...] = table(
        about="Other parameters that the same `[[trial.set]]` sets, with their values.", optional=True
    )
    answer: str = choice("accepted", "refused", about="Whether the node must accept the value or refuse it.")


def sets_parameter(evidence: Evidence, params: SetsParameter) -> Finding:
    """The node accepted the value, or refused it with a reason."""
    name, value = params.parameter, shown(params.value) + _also(params)
    with_reason = " with a reason" if params.answer == "refused" else ""
    expected = f"Setting {name} to {value} is {params.answer}{with_reason}."
    where = evidence.place("add_on_set_parameters_callback", "declare_parameter")
    call = next((each for each in set_calls(evidence) if _sets(each, params)), None)
    result = _result(call)
    if result is None:
        return _unanswered(evidence, f"The node did not respond when {name} was set.", expected, where)
    successful, reason = result["successful"], result["reason"].strip()
    if params.answer == "accepted" and not successful:
        return _refused(
            evidence, f"The node refused {name} = {value}: {_sentence(reason or 'no reason')}", expected, reason
        )
    if params.answer == "refused" and successful:
        text = (
            f"When {name} is set to {value}, the callback of add_on_set_parameters_callback must return "
            "SetParametersResult(successful=False, ...). ROS 2 calls this callback for all parameters of the node."
        )
        observed = f"The node accepted {name} = {value}."
        late = evidence.code.calls("add_post_set_parameters_callback")
        if late and not evidence.code.calls("add_on_set_parameters_callback"):
            text = "This callback is called after the change, so it cannot refuse a value."
            return failed(observed, expected, Cause("parameter-accepted", text, late[0].where))
        return failed(observed, expected, Cause("parameter-accepted", text, where))
    if params.answer == "refused" and not reason:
        text = "Set the field reason of the SetParametersResult to a sentence for the user."
        observed = f"The node refused {name} = {value} without a reason."
        return failed(observed, expected, Cause("no-reason", text, where))
    return passed(f"The node {params.answer} {name} = {value}" + (f": {_sentence(reason)}" if reason else "."))


def _sentence(reason: str) -> str:
    """Return the reason with one full stop at the end."""
    return f"{shorten(reason).removesuffix('.')}."


def _unanswered(evidence: Evidence, observed: str, expected: str, where: Where | None) -> Finding:
    crash, ended = crash_of(evidence), end_observed(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, ended, expected)
    text = (
        "A node responds only while it is spun, no callback blocks it, and its parameter services are not turned off."
    )
    return failed(f"{observed} {ended}".strip(), expected, Cause("no-response", "" if ended else text, where))


def set_calls(evidence: Evidence) -> list[Call]:
    """Return the calls by the trial that set a parameter of the node, in order."""
    return [call for call in calls_of(evidence) if call.by_trial and call.service.endswith(SET)]


def was_accepted(call: Call) -> bool:
    """Return whether the node accepted the values that this call sets."""
    return bool((_result(call) or {}).get("successful"))


def _sets(call: Call, params: SetsParameter) -> bool:
    given = [(each["name"], each["value"].get("double_value")) for each in call.request["parameters"]]
    return given == [(params.parameter, params.value), *params.also]


def _also(params: SetsParameter) -> str:
    return "".join(f" and {name} = {shown(value)}" for name, value in params.also)


def _result(call: Call | None) -> Any | None:  # noqa: ANN401 - a SetParametersResult as plain data
    """Return the result of a call that sets one or more parameters, or None if the node did not respond."""
    response = (call.response or {}) if call is not None else {}
    return next(iter(response.get("results", [])), response.get("result"))


def _described(call: Call, name: str) -> Any | None:  # noqa: ANN401 - a ParameterDescriptor as plain data
    found = (call.response or {}).get("descriptors", [])
    # An undeclared parameter is described with the type 0 (not set).
    return next((each for each in found if each["name"] == name and each["type"] != 0), None)


def _undeclared(evidence: Evidence, name: str, expected: str) -> Finding:
    crash = crash_of(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, end_observed(evidence), expected)
    text = "declare_parameter declares a parameter, with its default value and its descriptor."
    where = evidence.place("declare_parameter", "get_parameter", "__init__")
    if others := [name_ for name_ in declared_names(evidence) if name_ != name]:
        text = f"The name is the first argument of declare_parameter. The node declares {a_list(others)}."
    return failed(f"The node has no parameter {name}.", expected, Cause("parameter-undeclared", text, where))


def declared_names(evidence: Evidence) -> list[str]:
    """Return the names of parameters that the source declares with declare_parameter, sorted."""
    calls = evidence.code.calls("declare_parameter")
    names = {evaluate(call.argument(0, "name"), call.module.names) for call in calls}
    return sorted(shorten(name) for name in names if isinstance(name, str))


def _refused(evidence: Evidence, observed: str, expected: str, reason: str) -> Finding:
    where = evidence.place("add_on_set_parameters_callback", "declare_parameter")
    if UNDECLARED in reason:
        declared = declared_names(evidence)
        more = f" The node declares {a_list(declared)}." if declared else ""
        text = f"Only a declared parameter can be set.{more}"
        return failed(observed, expected, Cause("parameter-undeclared", text, evidence.place("declare_parameter")))
    if reason == NOT_RETURNED:
        text = (
            "The callback must return a SetParametersResult in every case. Without return, the callback returns None."
        )
        several = _returns_several(evidence)
        return failed(observed, expected, several or Cause("result-not-returned", text, where))
    if reason.startswith(OTHER_TYPE):
        text = "The type of the default value is the type of the parameter. Write 2.0 instead of 2."
        return failed(observed, expected, Cause("parameter-type", text, evidence.place("declare_parameter")))
    if reason.startswith(READ_ONLY):
        return failed(observed, expected, Cause("parameter-range", "", evidence.place("declare_parameter")))
    if OUT_OF_RANGE.match(reason):
        text = "The range in the ParameterDescriptor does not contain this value."
        if STEP in reason:
            text = "The range has the field step, so it allows only some of the values between its limits. Remove step."
        return failed(observed, expected, Cause("parameter-range", text, evidence.place("declare_parameter")))
    text = "For every valid value, the callback must return SetParametersResult(successful=True)."
    return failed(observed, expected, Cause("parameter-refused", text, where))


def _returns_several(evidence: Evidence) -> Cause | None:
    """Return the cause if the callback for parameters returns a list or a tuple, else None."""
    names = {name for _, name in callbacks_of(evidence, "add_on_set_parameters_callback")}
    for module, method in methods_of(evidence):
        for node in ast.walk(method) if method.name in names else ():
            if isinstance(node, ast.Return) and isinstance(node.value, ast.List | ast.ListComp | ast.Tuple):
                text = "The callback must return one SetParametersResult for all its parameters, not a list or a tuple."
                return Cause("result-not-returned", text, Where(module.file, node.lineno))
    return None


DECLARES = Kind(
    "declares_parameter",
    "trial",
    "The parameter has a description and a range",
    Declares,
    declares,
    about="In the response to a `[[trial.call]]` to `/NODE/describe_parameters`, the parameter is a float with a "
    "description and the given range.",
)
SETS = Kind(
    "sets_parameter",
    "trial",
    "The node responds when a parameter is set",
    SetsParameter,
    sets_parameter,
    about="The node accepts a `[[trial.set]]`, or refuses it with a reason.",
)
