"""Decide whether a check of a trial in wall time may have failed because of the machine rather than the node.

A node that rarely gets a processor does everything later, so it does less before the end of the trial. A lack of
processor time can therefore explain any failed check that compares times, numbers of messages or trajectories. It
cannot explain a wrong name, a wrong type, a wrong value in a message, or an exception.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.certain import ON_EVERY_MACHINE
from grader.checks.outcome import Finding, Status

if TYPE_CHECKING:
    from grader.trial.recording import Recording

STARVED_S = 0.5
"""If the stalls of a trial take at least this long in total (s), they may be the reason why a check failed. Shorter
stalls matter only for some checks of times and trajectories. These checks take the stalls into account themselves."""
TOO_BUSY = "The machine was too busy to judge the check in wall time. Try again when the machine is less busy."


def too_busy() -> Finding:
    """Return the finding that the machine was too busy to judge a check."""
    return Finding(Status.ERROR, TOO_BUSY)


def unless_starved(finding: Finding, recording: Recording, off: float, per_s: float) -> Finding:
    """Return the finding, or an error finding if stalls of the machine can explain the wrong value.

    `off` is the distance of the value from its tolerance range, and `per_s` is how much the value can change per second
    of a stall. While the machine stalls, the turtle continues with its last command.
    """
    if finding.status is Status.FAILED and recording.stalls and off <= per_s * recording.stalled_s:
        return too_busy()
    return finding


def unless_too_busy(finding: Finding, recording: Recording) -> Finding:
    """Return the finding, or an error finding if the machine stalled so much that this may explain the failure."""
    if finding.status is not Status.FAILED or finding.diagnosis in ON_EVERY_MACHINE or recording.stalled_s < STARVED_S:
        return finding
    return too_busy()
