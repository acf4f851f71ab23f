"""Services: a node's requests and responses."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from grader.checks.subjects.services import ANSWERS, CALLS
from grader.tests.checks.made import every, evidence, found, recording
from grader.tests.checks.told import told
from grader.trial.observed import Call, Offer
from grader.trial.recording import ProcessEnd

PEN, SPAWN, BOOL = "/turtle1/set_pen", "/spawn", "std_srvs/srv/SetBool"


def asked(t_s: float, service: str, **request: Any) -> Call:  # noqa: ANN401
    return Call(t_s, service, "turtlesim/srv/SetPen", request, {}, t_s)


def paused(answered_s: float | None = 3.1, *, missing: bool = False, **response: Any) -> Call:  # noqa: ANN401
    return Call(3.0, "/pause", BOOL, {"data": True}, response or None, answered_s, by_trial=True, missing=missing)


@pytest.mark.parametrize(
    ("calls", "diagnosis"),
    [
        ([asked(1.0, PEN), asked(1.0, SPAWN, x=2.0)], None),
        ([asked(1.0, SPAWN, x=2.0), asked(1.0, PEN)], "service-order"),
        ([asked(1.0, PEN), asked(2.0, SPAWN, x=3.0)], "wrong-request"),
        ([asked(1.0, PEN)], "service-not-called"),
        ([asked(1.0, PEN), asked(2.0, "/other/spawn", x=2.0)], "service-name"),
    ],
)
def test_a_call_counts_with_its_fields_and_in_its_order(calls: list[Call], diagnosis: str | None) -> None:
    given = evidence(recording(every(0.5, 2.0, 1.0), calls=tuple(calls)))
    assert found(CALLS, given, service=SPAWN, fields=(("x", 2.0),), after=PEN).diagnosis == diagnosis


@pytest.mark.parametrize(
    ("call", "offers", "diagnosis"),
    [
        (paused(success=True), (), None),
        (paused(success=False), (), "wrong-response"),
        (paused(5.5, success=True), (), "slow-response"),
        (paused(None), (), "no-response"),
        (paused(None, missing=True), (), "service-missing"),
        (paused(None, missing=True), (Offer("/node", "/pausing", BOOL),), "service-name"),
        (paused(None, missing=True), (Offer("/node", "/pause", "std_srvs/srv/Trigger"),), "service-type"),
    ],
)
def test_an_answer_counts_in_time_and_with_its_fields(
    call: Call, offers: tuple[Offer, ...], diagnosis: str | None
) -> None:
    given = evidence(recording(every(0.5, 2.0, 1.0), calls=(call,), offers=offers))
    finding = found(ANSWERS, given, service="/pause", type=BOOL, fields=(("success", True),))
    assert finding.diagnosis == diagnosis


def answered(t_s: float, service: str, answered_s: float) -> Call:
    return replace(asked(t_s, service), answered_s=answered_s)


def about_calls(*made: Call, **changes: Any) -> str:  # noqa: ANN401
    """Return what is reported if the node makes these calls, and must call /spawn after the pen was set."""
    given = evidence(recording(every(0.5, 2.0, 1.0), calls=made))
    return told(found(CALLS, given, **{"service": SPAWN, "fields": (("x", 2.0),), "after": PEN, **changes}))


TWO, ZERO = asked(2.0, SPAWN, x=2.0), asked(2.0, SPAWN, x=0.0)
OTHERS = "/turtle2/set_pen"


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The node called /spawn with x=2.0.", [asked(1.0, PEN), TWO], [asked(1.0, PEN), ZERO]),
        (
            "The node called /spawn with x=2.0, but not after it had called /turtle1/set_pen.",
            [TWO],
            [asked(1.0, PEN), TWO],
        ),
        (
            "The node called /spawn with x=2.0 before /turtle1/set_pen had responded.",
            [answered(1.0, PEN, 2.5), TWO],
            [answered(1.0, PEN, 1.5), TWO],
        ),
        ("The most similar call to /spawn has x=3.0.", [asked(1.0, PEN), asked(2.0, SPAWN, x=3.0)], [TWO]),
        ("The most similar call to /spawn has x=1.0.", [ZERO, asked(3.0, SPAWN, x=1.0)], [ZERO]),
        ("All these fields have their default values: set them", [ZERO], [asked(2.0, SPAWN, x=3.0)]),
        ("The node never called /spawn.", [asked(1.0, PEN)], [asked(1.0, PEN), ZERO]),
        ("The node called /other/spawn instead of /spawn.", [asked(2.0, "/other/spawn")], [asked(1.0, PEN)]),
    ],
)
def test_a_sentence_about_a_call_is_true(words: str, true: list[Call], near: list[Call]) -> None:
    assert words in about_calls(*true)
    assert words not in about_calls(*near)


def test_the_order_of_the_calls_is_only_told_if_it_is_required() -> None:
    required = "Before this request, the node calls /turtle1/set_pen."
    assert required in about_calls(ZERO)
    assert required not in about_calls(ZERO, after=" ")


def test_only_the_services_of_a_turtle_belong_to_a_turtle() -> None:
    of_another = about_calls(asked(1.0, OTHERS), service=PEN)
    assert "The node called /turtle2/set_pen instead of /turtle1/set_pen." in of_another
    assert "Each turtle has its own services." in of_another
    assert "Each turtle has its own services." not in about_calls(asked(1.0, "/other/spawn"))
    parameters = about_calls(asked(1.0, "/other/get_parameters"), service="/turtlesim/get_parameters")
    assert "Each turtle has its own services." not in parameters


ENDED = ProcessEnd(by="itself", exit_code=0, t_s=3.2, stop_s=None)
BLOCKED = "Does something in the node block its callbacks?"


def about_answers(calls: list[Call], **changes: Any) -> str:  # noqa: ANN401
    given = evidence(recording(every(0.5, 2.0, 1.0), calls=tuple(calls), **changes))
    return told(found(ANSWERS, given, service="/pause", type=BOOL, fields=(("success", True),)))


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("The node responded to the call to /pause.", [paused(success=True)], [paused(success=False)]),
        (
            "The node responds to a call to /pause within 1 s, with success=True.",
            [paused(success=False)],
            [paused(success=True)],
        ),
        ("The response has success=False.", [paused(success=False)], [paused(success=True)]),
        (
            "The callback of a service fills in the fields of its second argument and returns this argument.",
            [paused(success=False)],
            [paused(5.5, success=False)],
        ),
        ("The response took 2.5 s.", [paused(5.5, success=True)], [paused(3.9, success=True)]),
        ("A callback must not sleep or wait.", [paused(5.5, success=True)], [paused(success=False)]),
        ("The node offers /pause, but it did not respond to the call.", [paused(None)], [paused(None, missing=True)]),
        (BLOCKED, [paused(None)], [paused(None, missing=True)]),
        ("The node offers no service.", [paused(None, missing=True)], [paused(None)]),
    ],
)
def test_a_sentence_about_a_response_is_true(words: str, true: list[Call], near: list[Call]) -> None:
    assert words in about_answers(true)
    assert words not in about_answers(near)


@pytest.mark.parametrize(("changes", "found"), [({"end": ENDED}, True), ({}, False)])
def test_a_call_that_was_not_made_is_told_from_a_call_without_a_response(
    changes: dict[str, Any], *, found: bool
) -> None:
    missed = about_answers([], **changes)
    assert ("The node had ended before the call." in missed) == found
    assert ("The trial had ended before the call." in missed) != found
    assert "had ended before the call." not in about_answers([paused(None, missing=True)], **changes)


def test_a_node_that_ended_after_a_call_did_not_block_its_callbacks() -> None:
    ended = about_answers([paused(None)], end=ENDED)
    assert "The node did not respond to the call to /pause. The node exited on its own after 3.2 s." in ended
    assert BLOCKED not in ended


def test_the_services_that_a_node_offers_are_named() -> None:
    missing = [paused(None, missing=True)]
    others = (Offer("/node", "/pausing", BOOL), Offer("/node", "/stop", BOOL))
    assert "No service is named /pause. The node offers /pausing and /stop." in about_answers(missing, offers=others)
    right_name = (Offer("/node", "/pause", "std_srvs/srv/Empty"),)
    assert "No service is named /pause." not in about_answers(missing, offers=right_name)
    below = about_answers(missing, offers=(Offer("/node", "/node/pause", BOOL),))
    assert "A name without a slash at the beginning is in the node's namespace" in below
    assert "A name without a slash" not in about_answers(missing, offers=others)
