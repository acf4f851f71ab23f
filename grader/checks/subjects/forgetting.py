"""Check that a node forgets a target that is no longer announced."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.kind import Kind, string
from grader.checks.outcome import Finding, failed, passed
from grader.checks.starved import unless_starved
from grader.checks.subjects.services import calls_of
from grader.common.words import shorten
from grader.evidence.targets import announcements
from grader.submission.constants import evaluate

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

REACTS_S = 0.3
"""How long (s) after the first announcement without a target's name the node may still call the service for this
target."""


@dataclass(frozen=True, kw_only=True)
class Forgets:
    """The topic with the names of the remaining turtles, and the service that removes a target."""

    topic: str = string("the full name of a topic", start="/", about="The topic with the names of the targets.")
    service: str = string("the full name of a service", start="/", about="The service that the node calls.")


def forgets(evidence: Evidence, params: Forgets) -> Finding:
    """The node soon stops calling the service for a withdrawn target.

    It may still call the service until REACTS_S after the first message that lacks the name of the target.
    """
    recording = evidence.recording
    expected = f"The node forgets a target that {params.topic} no longer contains, and does not drive to it."
    topic = [
        call.where
        for call in evidence.code.calls("create_subscription")
        if evaluate(call.argument(1, "topic"), call.module.names) == params.topic
    ]
    where = topic[0] if topic else evidence.place("create_subscription")
    gone_s = {track.turtle: track.gone_s for track in recording.tracks if track.gone_s is not None}
    for name in recording.withdrawn:
        heard = announcements(recording, params.topic)
        without = (each.t_s for each in heard if each.t_s > gone_s[name] and name not in each.names)
        told_s = next(without, math.inf)
        calls = [call for call in calls_of(evidence) if call.service == params.service and call.request["name"] == name]
        call = next((call for call in calls if call.t_s > told_s + REACTS_S), None)
        if call is not None:
            observed = (
                f"From {told_s:.1f} s on, {params.topic} did not contain {shorten(name)}. "
                f"At {call.t_s:.1f} s, the node called {params.service} for {shorten(name)}."
            )
            text = "In the callback of the topic, forget each target whose name is not in the message."
            finding = failed(observed, expected, Cause("not-forgotten", text, where))
            return unless_starved(finding, recording, off=call.t_s - told_s - REACTS_S, per_s=1.0)
    return passed("The node forgot the target that was no longer announced.")


FORGETS = Kind(
    "forgets_targets",
    "trial",
    "The node forgets targets that are no longer announced",
    Forgets,
    forgets,
    about="Once the topic no longer contains the target that the trial withdraws (`withdraws`), the node does not call "
    "the service for this target.",
)
