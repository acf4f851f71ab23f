"""The rate and the circle of a node that exits early: whether the exit is the reason that the check gives."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.tests.checks.made import NODE_FILE, every, evidence, finding, node, recording
from grader.tests.checks.shapes import TRACEBACK
from grader.trial.recording import Output, ProcessEnd

if TYPE_CHECKING:
    from grader.checks.outcome import Finding

PUBLISH = "        self.publisher.publish(msg)"
EXITS = (PUBLISH, f"{PUBLISH}\n        raise SystemExit")
CANCELS = (PUBLISH, f"{PUBLISH}\n        self.timer.cancel()")
ONLY_IF = (PUBLISH, f"        if self.due():\n    {PUBLISH}")
"""Each a change of the node of the tutorial."""


def rate(period_s: float, until_s: float, exit_s: float, *changes: tuple[str, str], crashes: bool = False) -> Finding:
    return judged("rate", period_s, until_s, exit_s, *changes, crashes=crashes)


def judged(
    check: str, period_s: float, until_s: float, exit_s: float, *changes: tuple[str, str], crashes: bool = False
) -> Finding:
    """Return what the check finds if commands arrive until `until_s`, and the node exits on its own at `exit_s`."""
    end = ProcessEnd(by="itself", exit_code=int(crashes), t_s=exit_s, stop_s=None)
    errors = Output(TRACEBACK if crashes else "")
    commands = every(period_s, 2.0, 1.0, until_s=until_s)
    return finding(check, evidence(recording(commands, end=end, sigint_t_s=exit_s, stderr=errors), node(*changes)))


def test_a_node_that_exits_while_it_publishes_at_the_right_rate_is_told_where_it_exits() -> None:
    found = rate(0.5, 3.1, 3.2, EXITS)
    assert found.observed == (
        "The last command arrived at 3.0 s, 7.0 s before the end. The node exited on its own after 3.2 s."
    )
    assert (found.diagnosis, found.cause) == ("stopped-early", "This line may end the program.")
    assert str(found.where) == f"{NODE_FILE}:17"


@pytest.mark.parametrize("crashes", [False, True])
@pytest.mark.parametrize(
    ("change", "cause"),
    [
        (CANCELS, "cancel stops the timer, so the timer does not call its method again."),
        (ONLY_IF, "publish is called only if the condition on line 16 is true."),
    ],
)
def test_a_node_that_stops_publishing_long_before_it_exits_does_not_stop_because_of_the_exit(
    change: tuple[str, str], cause: str, *, crashes: bool
) -> None:
    late, soon = (rate(0.5, 3.1, exit_s, change, crashes=crashes) for exit_s in (8.0, 3.2))
    assert (late.diagnosis, late.cause) == ("stopped-early", cause)
    assert "exited" not in late.observed
    assert "crashed" not in late.observed
    assert cause != soon.cause
    assert f"The node {'crashed' if crashes else 'exited on its own'} after 3.2 s" in soon.observed


def test_a_late_exit_without_another_reason_is_not_called_the_reason() -> None:
    found = rate(0.5, 3.1, 8.0)
    assert (found.diagnosis, found.cause) == ("stopped-early", "")


@pytest.mark.parametrize(
    ("exit_s", "change", "diagnosis"),
    [
        (9.0, CANCELS, "published-once"),
        (9.0, ("self.create_timer(0.5,", "self.create_timer(7.0,"), "timer-period"),
        (1.0, ("self.create_timer(0.5,", "self.create_timer(7.0,"), "ended-early"),
        (1.0, CANCELS, "ended-early"),
        (9.0, ("", ""), "ended-early"),
    ],
)
def test_a_single_command_is_explained_by_the_exit_only_if_the_node_exits_soon_after_it(
    exit_s: float, change: tuple[str, str], diagnosis: str
) -> None:
    found = rate(0.5, 0.6, exit_s, change)
    assert found.diagnosis == diagnosis
    assert ("exited on its own" in found.observed) == (diagnosis == "ended-early")


@pytest.mark.parametrize("crashes", [False, True])
def test_a_wrong_rate_comes_before_an_early_exit(*, crashes: bool) -> None:
    found = rate(1.0, 3.1, 3.2, ("self.create_timer(0.5,", "self.create_timer(1.0,"), crashes=crashes)
    assert found.diagnosis == "timer-period"
    assert found.observed.endswith(" s (1.0 Hz).")


@pytest.mark.parametrize("crashes", [False, True])
def test_a_circle_is_too_short_because_of_an_exit_only_if_commands_arrived_until_then(*, crashes: bool) -> None:
    late, soon = (judged("circle", 0.5, 3.1, exit_s, CANCELS, crashes=crashes) for exit_s in (8.0, 3.2))
    assert (late.diagnosis, late.cause) == ("stopped-early", "The turtle stops when no command arrives for 1 s.")
    assert soon.diagnosis == ("crash" if crashes else "ended-early")
