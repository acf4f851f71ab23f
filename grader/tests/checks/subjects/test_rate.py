from __future__ import annotations

from itertools import accumulate
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.outcome import Finding, Status
from grader.checks.subjects.log import LOG_RATE
from grader.checks.subjects.rate import RATE
from grader.tests.checks.made import NODE_FILE, every, evidence, finding, node, recording
from grader.tests.checks.made import found as found_by
from grader.tests.checks.shapes import SHAPES, uneven
from grader.tests.checks.told import told
from grader.trial.recording import ClockName, LogLine

if TYPE_CHECKING:
    from grader.tests.checks.made import Timed

TIMER = "self.create_timer(0.5, self.send)"


def rate(shape: str, *changes: tuple[str, str]) -> Finding:
    return finding("rate", evidence(SHAPES[shape](), node(*changes)))


@pytest.mark.parametrize(
    ("shape", "diagnosis", "observed"),
    [
        ("one hertz", "wrong-rate", "Commands arrived every 1.00 s (1.0 Hz)."),
        ("four hertz", "wrong-rate", "Commands arrived every 0.25 s (4.0 Hz)."),
        ("ten kilohertz", "wrong-rate", "98999 commands arrived, one every 0.10 ms."),
        ("once", "published-once", "1 command arrived in 10 s."),
        ("twice", "too-few-commands", "2 commands arrived in 10 s."),
        ("late", "late-start", "The first command arrived 3.7 s after the start."),
        ("three quarters", "stopped-early", "The last command arrived at 4.0 s, 6.0 s before the end."),
        (
            "crash",
            "crash",
            (
                "The last command arrived at 4.0 s, 6.0 s before the end. "
                "The node crashed after 4.5 s: ZeroDivisionError: division by zero."
            ),
        ),
    ],
)
def test_each_wrong_rhythm_fails_for_its_own_reason(shape: str, diagnosis: str, observed: str) -> None:
    found = rate(shape)
    assert (found.status, found.diagnosis, found.observed) == (Status.FAILED, diagnosis, observed)
    lines = {"wrong-rate": 10, "crash": 14}
    assert str(found.where) == f"{NODE_FILE}:{lines.get(diagnosis, 16)}"


def test_the_right_rate_is_reported_as_the_nominal_one() -> None:
    found = rate("good")
    assert (found.status, found.observed) == (Status.PASSED, "Commands arrive every 0.50 s (2.0 Hz).")
    assert not found.near_edge


def test_an_uneven_rhythm_names_the_worst_interval() -> None:
    found = rate("uneven")
    assert found.diagnosis == "uneven-rate"
    assert found.observed.startswith("Commands arrived at uneven intervals: 0.71 s passed between two of them")


def test_three_commands_that_stop_early_are_reported_as_such() -> None:
    three = finding("rate", evidence(recording(every(0.5, 2.0, 1.0, until_s=1.7))))
    assert (three.diagnosis, three.observed) == (
        "stopped-early",
        "The last command arrived at 1.5 s, 8.5 s before the end.",
    )


def test_commands_that_all_come_at_once_have_no_rate() -> None:
    found = finding("rate", evidence(recording([(0.5, 2.0, 1.0)] * 4)))
    assert (found.status, found.observed) == (Status.FAILED, "4 commands arrived, one every 0.00 ms.")


@pytest.mark.parametrize(
    ("moved_s", "diagnosis"), [(0.14, None), (0.16, "uneven-rate"), (-0.09, None), (-0.11, "uneven-rate")]
)
def test_each_interval_has_limits_of_its_own(moved_s: float, diagnosis: str | None) -> None:
    times = [0.5 * index + (moved_s if index >= 10 else 0.0) for index in range(1, 20)]
    made = recording([(t_s, 2.0, 1.0) for t_s in times])
    limits = {"rate_hz": 2.0, "min_interval_s": 0.4, "max_interval_s": 0.65}
    found = found_by(RATE, evidence(made), **limits)
    assert found.diagnosis == diagnosis
    if diagnosis:
        assert found.observed == (
            f"Commands arrived at uneven intervals: {0.5 + moved_s:.2f} s passed between two of them, "
            "4.5 s after the start."
        )


def test_an_interval_within_the_limits_is_never_shown_as_uneven() -> None:
    times = [0.5, 1.0, 1.38, 2.02, 2.5, *(3.0 + 0.5 * index for index in range(14))]
    limits = {"rate_hz": 2.0, "min_interval_s": 0.4, "max_interval_s": 0.65}
    found = found_by(RATE, evidence(recording([(t_s, 2.0, 1.0) for t_s in times])), **limits)
    assert (found.diagnosis, found.observed.split(":")[1].split(" s ")[0]) == ("uneven-rate", " 0.38")


def test_the_interval_that_is_worst_either_way_is_shown() -> None:
    times = [0.5, 1.0, 1.1, 1.6, 2.1, 2.9, *(3.4 + 0.5 * index for index in range(13))]
    found = finding("rate", evidence(recording([(t_s, 2.0, 1.0) for t_s in times])))
    assert (found.diagnosis, found.observed.split(":")[1].split(" s ")[0]) == ("uneven-rate", " 0.10")


@pytest.mark.parametrize(
    ("shape", "diagnosis", "observed"),
    [
        ("ends at once", "ends-at-once", "0 commands arrived in 10 s. The node exited on its own at startup."),
        (
            "crash at the start",
            "crash",
            "0 commands arrived in 10 s. The node crashed at startup: ZeroDivisionError: division by zero.",
        ),
    ],
)
def test_too_few_commands_are_explained_by_the_end(shape: str, diagnosis: str, observed: str) -> None:
    found = rate(shape)
    assert (found.diagnosis, found.observed) == (diagnosis, observed)


def test_log_lines_have_names_of_their_own() -> None:
    nothing = LogLine(1.0, "INFO", "draw_circle", "Hello 1")
    limits = {"rate_hz": 1.0, "min_interval_s": 0.8, "max_interval_s": 1.2}
    some = [evidence(recording([], log=(nothing,) * amount)) for amount in (1, 2)]
    assert [found_by(LOG_RATE, given, format="Hello {counter}", **limits).diagnosis for given in some] == [
        "logged-once",
        "too-few-log-lines",
    ]


@pytest.mark.parametrize(
    ("period_s", "near", "status"),
    [
        (0.5, False, "passed"),
        (0.478, True, "passed"),
        (0.472, True, "failed"),
        (0.46, False, "failed"),
        (0.54, False, "failed"),
    ],
)
def test_a_mean_near_the_edge_is_for_wall_time_to_judge(period_s: float, near: bool, status: str) -> None:
    found = finding("rate", evidence(recording(every(period_s, 2.0, 1.0))))
    assert (found.near_edge, found.status.value) == (near, status)


@pytest.mark.parametrize(
    ("hz", "clock", "near"), [(62.5, "simulated", True), (62.5, "wall", False), (25.0, "simulated", False)]
)
def test_a_rate_above_40_hz_is_for_wall_time_to_judge(hz: float, clock: ClockName, near: bool) -> None:
    """Simulated time has frames of 16 ms, so a trial in simulated time cannot measure a rate above 40 Hz."""
    found = finding("rate", evidence(recording(every(1.0 / hz, 2.0, 1.0), clock=clock)))
    assert (found.near_edge, found.status) == (near, Status.FAILED)


@pytest.mark.parametrize(("hz", "timer", "near"), [(62.5, True, True), (62.5, False, False), (50.0, False, True)])
def test_simulated_time_shows_the_rate_of_a_node_that_acts_once_per_pose(hz: float, timer: bool, near: bool) -> None:
    source = () if timer else ((TIMER, "self.create_subscription(Pose, '/turtle1/pose', self.send, 10)"),)
    found = finding("rate", evidence(recording(every(1.0 / hz, 2.0, 1.0)), node(*source)))
    assert found.near_edge == near


@given(st.lists(st.floats(0.42, 0.62), min_size=15, max_size=20))
def test_the_mean_from_first_to_last_arrival_decides_where_each_interval_is_allowed(intervals: list[float]) -> None:
    times = list(accumulate(intervals, initial=0.5))
    made = recording([(t_s, 2.0, 1.0) for t_s in times], sigint_t_s=times[-1] + 0.5)
    mean_hz = len(intervals) / (times[-1] - times[0])
    found = finding("rate", evidence(made))
    assert (found.status is Status.PASSED) == (1.9 <= mean_hz <= 2.1)


@given(st.one_of(st.floats(0.05, 1.89), st.floats(2.11, 40.0)))
def test_every_rate_outside_the_tolerance_fails(rate_hz: float) -> None:
    times = [index / rate_hz for index in range(1, int(9.99 * rate_hz) + 1)]
    found = finding("rate", evidence(recording([(t_s, 2.0, 1.0) for t_s in times])))
    assert found.status is Status.FAILED


def test_what_a_stall_of_the_machine_delayed_is_not_held_against_the_node() -> None:
    times = [(0.5 * index + (0.18 if index == 9 else 0.0), 2.0, 1.0) for index in range(1, 20)]
    attentive = recording(times, clock="wall")
    stalled = recording(times, clock="wall", stalls=((4.4, 4.67),))
    elsewhere = recording(times, clock="wall", stalls=((7.1, 7.4),))
    assert finding("rate", evidence(attentive)).diagnosis == "uneven-rate"
    assert finding("rate", evidence(stalled)).status is Status.PASSED
    assert finding("rate", evidence(elsewhere)).diagnosis == "uneven-rate"


def test_a_machine_that_stalls_all_the_time_judges_no_rate() -> None:
    times = [(0.5 * index, 2.0, 1.0) for index in range(1, 20)]
    found = finding("rate", evidence(recording(times, clock="wall", stalls=((0.0, 8.0),))))
    assert found.status is Status.ERROR


def test_half_of_the_intervals_are_enough_to_judge() -> None:
    commands = every(0.5, 2.0, 1.0, until_s=2.6)
    found = finding("rate", evidence(recording(commands, clock="wall", stalls=((0.95, 1.02),))))
    assert found.diagnosis == "stopped-early"


def test_a_command_after_ctrl_c_is_not_counted() -> None:
    assert rate("more after Ctrl-C").status is Status.PASSED


@pytest.mark.parametrize("arrives_s", [0.0, 0.1])
def test_what_was_sent_before_the_clock_started_is_in_no_interval(arrives_s: float) -> None:
    """The first command arrives after discovery, which takes a while."""
    late = [(arrives_s, 2.0, 1.0), *every(0.5, 2.0, 1.0, first_s=0.3)]
    found = finding("rate", evidence(recording(late)))
    assert (found.status, found.near_edge) == (Status.PASSED, False)


def test_commands_before_the_clock_started_count_as_lost() -> None:
    heard, lost = evidence(recording([(0.0, 2.0, 1.0)] * 3)), evidence(recording([]))
    assert finding("topic", heard) == finding("topic", lost)
    assert finding("topic", heard).diagnosis == "never-publishes"
    assert heard.commands == ()
    assert finding("topic", evidence(recording([(0.0, 2.0, 1.0), (0.5, 2.0, 1.0)]))).status is Status.PASSED


def test_the_requested_rate_is_not_rounded() -> None:
    limits = {"min_interval_s": 3.0, "max_interval_s": 5.0, "first_within_s": 5.0}
    slow = recording(every(4.0, 2.0, 1.0, until_s=20.0), duration_s=20.0, sigint_t_s=20.0)
    observed = found_by(RATE, evidence(slow), rate_hz=0.25, **limits).observed
    assert observed == "Commands arrive every 4.00 s (0.25 Hz)."


EVEN, UNEVEN = every(0.5, 2.0, 1.0), uneven()


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("Commands arrive every 0.50 s, and each interval is between 0.4", UNEVEN, EVEN),
        ("Commands arrived at uneven intervals: 0.71 s passed between two of them", UNEVEN, EVEN),
        ("Commands arrive every 0.50 s (2.0 Hz).", EVEN, UNEVEN),
        ("The first command arrives within", every(0.5, 2.0, 1.0, first_s=3.7), EVEN),
    ],
)
def test_a_sentence_about_the_rate_is_true(words: str, true: list[Timed], near: list[Timed]) -> None:
    assert words in told(finding("rate", evidence(recording(true))))
    assert words not in told(finding("rate", evidence(recording(near))))
