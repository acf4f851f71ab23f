"""Checks of services: the node's requests to the simulator, and its responses to the trial."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed
from grader.checks.causes.why_blocked import not_spun, why_blocked
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_ended import why_ended
from grader.checks.causes.why_unasked import why_unasked
from grader.checks.kind import Kind, number, string, table
from grader.checks.outcome import Finding, failed, passed
from grader.checks.tolerance import Band
from grader.common.words import a_list, nearest, shorten
from grader.common.words import number as shown
from grader.evidence import activity

if TYPE_CHECKING:
    from collections.abc import Iterable

    from grader.evidence.evidence import Evidence
    from grader.trial.observed import Call

AT_ONCE_S = 0.05
"""A call counts as earlier than a response only if it is earlier by more than this time (s), because times that are
measured in wall time are not exact."""
OF_TURTLES = re.compile(r"/turtle\d")
"""Matches the names of services that each turtle has, such as /turtle1/set_pen, but not /turtlesim/get_parameters."""
CLOSE = 1e-3
"""The maximum error of a number in a request or a response. Many fields are float32."""


@dataclass(frozen=True, kw_only=True)
class CallsService:
    """A call to a simulator service, with these fields in the request.

    `after` is the name of a service that the node must call first.
    """

    service: str = string("the full name of a service", start="/", about="The name of the service.")
    fields: tuple[tuple[str, Any], ...] = table(
        about="The fields of the request that are compared, with the required values."
    )
    after: str = string(
        "the full name of a service",
        default=" ",
        about="A service that the node must call, and that must respond, before this call. Without this key, the order "
        "of the calls does not matter.",
    )


def calls_service(evidence: Evidence, params: CallsService) -> Finding:
    """The node called the service with these fields and, if `after` is set, after the response from that service."""
    request = ", ".join(f"{name}={_value(value)}" for name, value in params.fields)
    after = params.after.strip()
    expected = f"The node calls {params.service} with {request}."
    expected += f" Before this request, the node calls {after}." if after else ""
    made = [call for call in calls_of(evidence) if not call.by_trial]
    calls = [call for call in made if call.service == params.service]
    right = [
        index for index, call in enumerate(made) if call in calls and not wrong_fields(call.request, params.fields)
    ]
    if right:
        # Two calls may arrive at the same time, so compare their order instead of their times.
        first = next((index for index, call in enumerate(made) if call.service == after), None) if after else -1
        in_order = first is not None and right[-1] >= first
        too_early = bool(first is not None and after) and _before_the_answer(made[right[-1]], made[first or 0])
        if in_order and not too_early:
            return passed(f"The node called {params.service} with {request}.")
        text = f"Send this request in the callback that receives the response from {after}."
        observed = f"The node called {params.service} with {request}, but not after it had called {after}."
        if in_order:
            observed = f"The node called {params.service} with {request} before {after} had responded."
        return failed(observed, expected, Cause("service-order", text, evidence.place("call_async")))
    crash = crash_of(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, end_observed(evidence), expected)
    if calls:
        return _other_request(evidence, params, calls, expected)
    others = [call for call in made if call.service.rpartition("/")[2] == params.service.rpartition("/")[2]]
    observed = f"The node never called {params.service}."
    if others:
        observed = f"The node called {shorten(others[0].service)} instead of {params.service}."
        text = "Each turtle has its own services." if OF_TURTLES.match(params.service) else ""
        return failed(observed, expected, Cause("service-name", text, evidence.place("create_client")))
    return failed(observed, expected, why_unasked(evidence, params.service))


def _before_the_answer(call: Call, asked: Call) -> bool:
    """Return whether `call` arrived before the response to the other call, `asked`.

    Without a response, return False. If there was no delay, the call and the response have the same time.
    """
    return asked.answered_s is not None and call.t_s < asked.answered_s - AT_ONCE_S


def _other_request(evidence: Evidence, params: CallsService, calls: list[Call], expected: str) -> Finding:
    nearest_call = min(calls, key=lambda call: _difference(call.request, params.fields))
    wrong = wrong_fields(nearest_call.request, params.fields)
    seen = ", ".join(f"{name}={_value(nearest_call.request.get(name))}" for name in wrong)
    observed = f"The most similar call to {params.service} has {seen}."
    where = next((place for name in wrong if (place := evidence.code.assigned(name)) is not None), None)
    zero = all(not nearest_call.request.get(name) for name, _ in params.fields)
    text = "All these fields have their default values: set them before the call." if zero else ""
    return failed(observed, expected, Cause("wrong-request", text, where or evidence.place("call_async", "Request")))


@dataclass(frozen=True, kw_only=True)
class AnswersCall:
    """The node's response to the trial's `nth` call to the service, counted from 1."""

    service: str = string("the full name of a service", start="/", about="The name of the service.")
    type: str = string("a service type, such as std_srvs/srv/SetBool", about="The type of the service.")
    nth: float = number(
        1, at_least=1, about="The number of the judged call, counted from 1 among the trial's calls to this service."
    )
    within_s: float = number(1.0, above=0, about="The maximum time until the response.")
    fields: tuple[tuple[str, Any], ...] = table(
        about="The fields of the response that are compared, with the required values."
    )


def answers_call(evidence: Evidence, params: AnswersCall) -> Finding:
    """The node responded to the trial's call in time, with these fields."""
    wanted = ", ".join(f"{name}={_value(value)}" for name, value in params.fields)
    expected = f"The node responds to a call to {params.service} within {params.within_s:g} s, with {wanted}."
    calls = [call for call in calls_of(evidence) if call.by_trial and call.service == params.service]
    call = calls[int(params.nth) - 1] if len(calls) >= params.nth else None
    if call is None or call.missing or call.response is None or call.answered_s is None:
        return no_response(evidence, params.service, params.type, call, expected)
    took = Band.at_most(params.within_s)
    took_s = call.answered_s - call.t_s
    if not took.holds(took_s):
        cause = Cause("slow-response", "A callback must not sleep or wait.", evidence.place("create_service"))
        return failed(f"The response took {took_s:.1f} s.", expected, cause, near_edge=took.near(took_s))
    wrong = wrong_fields(call.response, params.fields)
    if wrong:
        seen = ", ".join(f"{name}={_value(call.response.get(name))}" for name in wrong)
        text = "The callback of a service fills in the fields of its second argument and returns this argument."
        cause = Cause("wrong-response", text, evidence.place("create_service"))
        return failed(f"The response has {seen}.", expected, cause)
    return passed(f"The node responded to the call to {params.service}.", near_edge=took.near(took_s))


def no_response(evidence: Evidence, service: str, type_: str, call: Call | None, expected: str) -> Finding:
    """Return the failed finding about a call by the trial, to which the node did not respond."""
    crash = crash_of(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, end_observed(evidence), expected)
    where = evidence.place("create_service")
    ended = end_observed(evidence)
    if call is None:
        observed = f"{'The node' if ended else 'The trial'} had ended before the call."
        return failed(observed, expected, Cause("no-response", where=where))
    if not call.missing and ended:
        observed = f"The node did not respond to the call to {service}. {ended}"
        return failed(observed, expected, why_ended(evidence))
    if not call.missing:
        cause = (
            why_blocked(evidence)
            or not_spun(evidence)
            or Cause("no-response", "Does something in the node block its callbacks?", where)
        )
        return failed(f"The node offers {service}, but it did not respond to the call.", expected, cause)
    return _missing(evidence, service, type_, expected)


def _missing(evidence: Evidence, service: str, type_: str, expected: str) -> Finding:
    where = evidence.place("create_service")
    offers = evidence.recording.offers
    same = [offer for offer in offers if offer.service == service]
    if same:
        observed = f"{service} has the type {shorten(same[0].type)}."
        text = f"The type is the first argument of create_service. The exercise asks for {type_}."
        return failed(observed, expected, Cause("service-type", text, where))
    names = sorted({offer.service for offer in offers})
    if names:
        guess = nearest(service, names) or names[0]
        observed = f"No service is named {service}. The node offers {a_list([shorten(name) for name in names])}."
        text = (
            f"The name is the second argument of create_service. The name of the service is {service}, including the "
            "slash."
        )
        if guess.endswith(service):
            text = (
                "A name without a slash at the beginning is in the node's namespace. ROS 2 replaces ~ with the name "
                "of the node."
            )
        return failed(observed, expected, Cause("service-name", text, where))
    stuck = why_blocked(evidence)
    text = "create_service offers a service." if not evidence.code.calls("create_service") else ""
    return failed("The node offers no service.", expected, stuck or Cause("service-missing", text, where))


def calls_of(evidence: Evidence) -> list[Call]:
    """Return the service calls before the end of the scenario, in order."""
    until = activity.end_s(evidence.recording)
    return [call for call in evidence.recording.calls if call.t_s < until]


def wrong_fields(given: Any, fields: Iterable[tuple[str, Any]]) -> list[str]:  # noqa: ANN401 - a request or response
    """Return the names of the fields that do not have the required values."""
    return [name for name, value in fields if not _same(given.get(name), value)]


def _difference(given: Any, fields: Iterable[tuple[str, Any]]) -> tuple[int, float]:  # noqa: ANN401 - a request
    """Return the number of fields with wrong values, and the sum of the errors of the numbers."""
    pairs = [(given.get(name), value) for name, value in fields]
    numbers = [(has, value) for has, value in pairs if isinstance(has, int | float) and isinstance(value, int | float)]
    return len(wrong_fields(given, fields)), sum(abs(has - value) for has, value in numbers)


def _same(given: object, wanted: object) -> bool:
    if isinstance(given, int | float) and isinstance(wanted, int | float) and not isinstance(wanted, bool):
        return abs(given - wanted) <= CLOSE
    return type(given) is type(wanted) and given == wanted


def _value(value: object) -> str:
    if isinstance(value, int) or value is None:
        return str(value)
    return shown(round(value, 3)) if isinstance(value, float) else f'"{shorten(str(value))}"'


CALLS = Kind(
    "calls_service",
    "trial",
    "The node calls a service",
    CallsService,
    calls_service,
    about="The node calls a service of the simulator, with certain values in the request.",
)
ANSWERS = Kind(
    "answers_call",
    "trial",
    "The node responds",
    AnswersCall,
    answers_call,
    about="The node responds to a `[[trial.call]]` in time, with certain values in the response.",
)
