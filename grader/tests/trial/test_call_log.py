"""The service calls in a recording."""

from __future__ import annotations

from types import SimpleNamespace

from grader.trial.call_log import MOST_ALIKE, MOST_CALLS, CallLog

EMPTY = SimpleNamespace(get_fields_and_field_types=dict)
"""A request or a response without fields, without ROS 2."""


def test_harmless_calls_do_not_hide_a_call_of_another_service() -> None:
    log = CallLog(lambda: 1.0)
    for number in range(2 * MOST_CALLS):
        log.answered(f"/turtle{number}/set_pen", "turtlesim/srv/SetPen", EMPTY, EMPTY, 0.0)
    assert len(log.calls) == MOST_CALLS
    for _ in range(2 * MOST_ALIKE):
        log.overheard("/catch", "turtlesim/srv/Kill", EMPTY)
    assert [call.service for call in log.calls].count("/catch") == MOST_ALIKE


def test_a_call_has_the_times_of_its_arrival_and_its_answer() -> None:
    log = CallLog(lambda: 2.0)
    log.answered("/clear", "std_srvs/srv/Empty", EMPTY, EMPTY, 0.5)
    (call,) = log.calls
    assert (call.t_s, call.answered_s) == (1.5, 2.0)
