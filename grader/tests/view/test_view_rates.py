from __future__ import annotations

import pytest

from grader.view.rates import WINDOW_S, Arrivals


def arrivals(*times_s: float, count: int = 1) -> Arrivals:
    made = Arrivals()
    for time_s in times_s:
        made.add(time_s, count)
    return made


def test_a_rate_is_reported_from_the_second_arrival_on() -> None:
    assert arrivals(1.0).hertz(1.1) is None
    assert arrivals(1.0, 1.5).hertz(1.6) == pytest.approx(2.0)


def test_several_arrivals_may_be_reported_at_once() -> None:
    assert arrivals(0.0, 0.1, 0.2, 0.3, count=5).hertz(0.3) == pytest.approx(50.0)


def test_old_messages_do_not_count_for_the_rate() -> None:
    slow_then_fast = [0.0, 1.0, 2.0, *(3.0 + 0.1 * number for number in range(round(10 * WINDOW_S) + 20))]
    assert arrivals(*slow_then_fast).hertz(slow_then_fast[-1]) == pytest.approx(10.0)


def test_after_a_pause_the_rate_is_that_of_the_new_messages() -> None:
    assert arrivals(0.0, 20.0, 20.5).hertz(20.6) == pytest.approx(2.0)


def test_a_topic_that_fell_silent_has_no_rate() -> None:
    twice_a_second = arrivals(0.0, 0.5, 1.0)
    assert twice_a_second.hertz(2.0) == pytest.approx(2.0)
    assert twice_a_second.hertz(2.3) is None


def test_a_slow_topic_is_not_taken_for_silent_between_two_messages() -> None:
    assert arrivals(0.0, 10.0, 20.0).hertz(29.0) == pytest.approx(0.1)
