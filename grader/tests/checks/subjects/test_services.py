"""Services: a node's requests and responses, a pause, and an arc in another colour."""

from __future__ import annotations

from typing import Any

import pytest

from grader.checks.outcome import Status
from grader.checks.subjects.arc import ARC
from grader.checks.subjects.pause import PAUSE
from grader.checks.subjects.services import ANSWERS, CALLS
from grader.tests.checks.made import every, evidence, found, recording
from grader.trial.observed import Call, Offer, PenChange

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


@pytest.mark.parametrize(
    ("rest", "diagnosis"),
    [
        ((3.0, 6.0), None),
        ((3.0, 99.0), "pause-never-ends"),
        ((4.0, 6.0), "pause-ignored"),
        ((99.0, 99.0), "pause-ignored"),
    ],
)
def test_a_turtle_stands_still_and_goes_on(rest: tuple[float, float], diagnosis: str | None) -> None:
    commands = [(t_s, *((0.0, 0.0) if rest[0] <= t_s < rest[1] else (v, w))) for t_s, v, w in every(0.1, 1.0, 1.0)]
    finding = found(PAUSE, evidence(recording(commands)), from_s=3.0, until_s=6.0)
    assert finding.diagnosis == diagnosis


def test_a_turtle_that_hears_nothing_rolls_on() -> None:
    commands = [each for each in every(0.1, 1.0, 1.0) if not 3.0 <= each[0] < 6.0]
    assert found(PAUSE, evidence(recording(commands)), from_s=3.0, until_s=6.0).diagnosis == "no-stop-command"


@pytest.mark.parametrize(
    ("values", "diagnosis"),
    [
        ({"radius_m": 2.0}, None),
        ({"radius_m": 1.5}, "wrong-radius"),
        ({"radius_m": 2.0, "speed_m_s": 2.0}, None),
        ({"radius_m": 2.0, "speed_m_s": 1.5}, "wrong-speed"),
        ({"radius_m": 2.0, "direction": "clockwise"}, "wrong-direction"),
        ({"radius_m": 2.0, "red": 200.0, "green": 0.0, "blue": 0.0}, None),
        ({"radius_m": 2.0, "red": 0.0, "green": 0.0, "blue": 0.0}, "not-in-colour"),
        ({"radius_m": 2.0, "angle_deg": 165.0, "until_s": 3.0}, None),
        ({"radius_m": 2.0, "angle_deg": 90.0, "until_s": 3.0}, "wrong-angle"),
    ],
)
def test_an_arc_is_measured_in_its_colour_and_time(values: dict[str, Any], diagnosis: str | None) -> None:
    pens = (PenChange(0.0, "turtle1", (200, 0, 0), 4, down=True),)
    finding = found(ARC, evidence(recording(every(0.1, 2.0, 1.0), pens=pens)), **values)
    assert (finding.diagnosis, finding.status is Status.PASSED) == (diagnosis, diagnosis is None)
