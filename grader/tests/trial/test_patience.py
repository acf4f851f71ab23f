"""How long simulated time waits for a node that has not come to rest."""

from __future__ import annotations

import pytest

from grader.trial.patience import HandshakePatience

LOOK_S = 0.5


def waited(*, asleep: float, wrote: bool = False, share: float = 0.0) -> float:
    """When patience ends (s) with a node that is seen asleep so often, and gets this share of a processor."""
    patience, now_s, seen = HandshakePatience(0.0), 0.0, 0.0
    while True:
        now_s += LOOK_S
        seen += asleep
        sleeps = seen >= 1.0
        seen -= sleeps
        if patience.ended(now_s, asleep=sleeps, wrote=wrote, worked_s=share * now_s):
            return now_s


@pytest.mark.parametrize(
    ("least_s", "most_s", "asleep", "wrote", "share"),
    [
        (20.0, 21.0, 1.0, False, 0.0),  # it sleeps, or waits for what never comes
        (20.0, 25.0, 0.9, False, 0.05),  # a loop that looks now and then
        (20.0, 21.0, 0.0, False, 1.0),  # it works without end, with a processor to itself
        (80.0, 81.0, 0.0, False, 0.25),  # with a quarter of one it may work as much
        (100.0, 101.0, 0.0, False, 0.05),
        (80.0, 81.0, 1.0, True, 0.25),  # it sleeps because we do not keep up with its output
        (100.0, 101.0, 1.0, True, 0.05),
    ],
)
def test_only_sleep_and_work_are_counted(
    least_s: float, most_s: float, asleep: float, wrote: bool, share: float
) -> None:
    assert least_s < waited(asleep=asleep, wrote=wrote, share=share) <= most_s
