"""Check the announcements of the remaining turtles: the names in each announcement, and the rate."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed
from grader.checks.causes.why_blocked import why_blocked
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_ended import why_ended
from grader.checks.causes.why_silent import why_nothing
from grader.checks.kind import Kind, number, string
from grader.checks.outcome import Finding, failed, passed
from grader.checks.starved import unless_starved
from grader.checks.subjects.services import calls_of
from grader.checks.tolerance import Band
from grader.common.words import a_list, shorten
from grader.evidence import activity
from grader.evidence.targets import announcements, is_there
from grader.submission.constants import number as number_of

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.evidence.targets import Announcement

LATE_S = 1.05
"""The maximum time (s) until a message shows a change: slightly more than two periods of 0.5 s."""
AT_ONCE_S = 0.1
"""If a turtle appears or disappears within this time (s) after a message, the message may contain its name or not."""
EMPTY = "At this time, there was no target. Even then, the node must publish a message with an empty string."
OTHER_SPACE = re.compile(r"[^\S ]")
NOT_IN_NAMES = re.compile(r"\W")
OFTEN = 3
"""The maximum number of messages per period. A node may also publish after each change."""


@dataclass(frozen=True, kw_only=True)
class Announces:
    """The topic with the names of the remaining turtles, and the time between two messages (s)."""

    topic: str = string(
        "the full name of a topic", start="/", about="The topic on which the node announces the turtles."
    )
    period_s: float = number(0.5, above=0, about="The time between two messages.")


def announces(evidence: Evidence, params: Announces) -> Finding:
    """Each message on the topic contains the names of all remaining turtles, and no other names.

    The messages arrive at the required rate, until the end.
    """
    expected = (
        f"Every {params.period_s:g} s, the node publishes the names of all remaining targets, separated by spaces."
    )
    heard = announcements(evidence.recording, params.topic)
    where = evidence.place("publish", "create_publisher")
    if not heard:
        crash = crash_of(evidence)
        if crash is not None:
            return crash_finding(evidence, crash, end_observed(evidence), expected)
        why = why_nothing(evidence, ("publish",)) or Cause("never-publishes", "", where)
        return failed(f"No String arrived on {params.topic}.", expected, why)
    for message in heard:
        finding = _wrong_names(evidence, message, heard, expected)
        if finding is not None:
            return finding
    times_s = [*(message.t_s for message in heard), activity.end_s(evidence.recording)]
    most = Band.at_most(1.4 * params.period_s)
    gaps = sorted(((later_s - at_s, at_s) for at_s, later_s in pairwise(times_s)), reverse=True)
    # A node that is silent only without targets has another mistake than a node whose timer is wrong.
    with_targets = [gap for gap in gaps if not most.holds(gap[0]) and _has_targets(evidence, *gap, most)]
    longest_s, begin_s = (with_targets or gaps)[0]
    if not most.holds(longest_s):
        observed = f"After the message at {begin_s:.1f} s, no message arrived for {longest_s:.1f} s."
        crash = crash_of(evidence)
        if crash is not None:
            return crash_finding(evidence, crash, end_observed(evidence), expected)
        cause = _of_period(evidence, longest_s)
        if evidence.recording.end.by == "itself" and begin_s == times_s[-2]:
            observed, cause = f"{observed} {end_observed(evidence)}", why_ended(evidence)
        elif not with_targets:
            cause = Cause("silent-when-empty", EMPTY, where)
        finding = failed(observed, expected, why_blocked(evidence) or cause, near_edge=most.near(longest_s))
        return unless_starved(finding, evidence.recording, off=longest_s - 1.4 * params.period_s, per_s=1.0)
    often = OFTEN * (times_s[-1] - times_s[0]) / params.period_s
    if len(heard) > max(often, OFTEN):
        observed = f"{len(heard)} messages arrived in {times_s[-1] - times_s[0]:.1f} s."
        cause = Cause("timer-period", "Publish in the callback of one timer.", evidence.place("create_timer"))
        return failed(observed, expected, cause)
    return passed("The node announces the remaining targets.", near_edge=most.near(longest_s))


def _of_period(evidence: Evidence, gap_s: float) -> Cause:
    """Return the cause for a gap (s) between two messages: the period of a timer, or a call that does not publish."""
    for timer in evidence.code.calls("create_timer"):
        period_s = number_of(timer.argument(0, "timer_period_sec"), timer.module.names)
        if period_s is not None and abs(period_s - gap_s) < 0.1 * gap_s:
            return Cause("timer-period", f"The period of this timer is {period_s:g} s.", timer.where)
    return Cause("timer-period", "Publish each time the timer fires.", evidence.place("create_timer"))


def _has_targets(evidence: Evidence, gap_s: float, begin_s: float, most: Band) -> bool:
    """Return whether a target existed at any time at which the next announcement was overdue."""
    late_s = begin_s + (most.high or 0.0)
    return any(is_there(track, late_s, begin_s + gap_s) for track in evidence.recording.tracks)


def _wrong_names(evidence: Evidence, message: Announcement, heard: list[Announcement], expected: str) -> Finding | None:
    """Return a failed finding if the message does not contain exactly the names of the existing turtles, else None.

    The message may or may not contain the name of a turtle that appeared or disappeared at most LATE_S before it or
    AT_ONCE_S after it. The name of a turtle that was caught, or that the node has asked turtlesim to remove, may be
    missing while the turtle still exists.
    """
    tracks = evidence.recording.tracks
    from_s, to_s = message.t_s - LATE_S, message.t_s
    where = evidence.place("publish")
    around = {track.turtle for track in tracks if is_there(track, from_s, to_s + AT_ONCE_S)}
    earlier = [call for call in calls_of(evidence) if call.t_s <= to_s]
    called = {str(call.request.get("name")) for call in earlier if call.by_trial or call.service == "/kill"}
    throughout = {
        track.turtle
        for track in tracks
        if track.rows[0][0] <= from_s and (track.gone_s is None or track.gone_s > to_s + AT_ONCE_S)
    }
    at = f"The message at {message.t_s:.1f} s"
    strange = [name for name in message.names if name not in around]
    known = {track.turtle for track in tracks}
    pieces = len(message.names) > 1 and "".join(message.names) in known
    spaced = OTHER_SPACE.search(message.text) is None
    if pieces or not spaced or any(name not in known and _is_of_parts(name, known) for name in strange):
        text = 'The text consists of the names, separated by single spaces: " ".join(names).'
        if pieces and max(map(len, message.names)) == 1:
            text = "join puts spaces between the letters, because it got one string. It needs a list of names."
        return failed(f'{at} is "{shorten(message.text)}".', expected, Cause("target-format", text, where))
    if strange:
        return _not_there(evidence, message, strange, expected)
    missing = sorted(throughout - called - set(message.names))
    if missing:
        observed = f"{at} does not contain {a_list([shorten(name) for name in missing])}."
        stuck = why_blocked(evidence)
        text = "Add the name of a turtle to the list in the callback that receives the response from /spawn."
        if any(missing[0] in each.names for each in heard if each.t_s < message.t_s):
            text = (
                f"An earlier message contained {shorten(missing[0])}, so the node has removed the name. "
                "The node may remove a name only when /catch is called with that name."
            )
        return failed(observed, expected, stuck or Cause("target-unannounced", text, where))
    return None


def _not_there(evidence: Evidence, message: Announcement, strange: list[str], expected: str) -> Finding:
    """Return the finding about the name of a turtle that does not exist yet, no longer exists or never existed."""
    at = f"The message at {message.t_s:.1f} s"
    begin_s = {track.turtle: track.rows[0][0] for track in evidence.recording.tracks}.get(strange[0])
    where = evidence.place("publish")
    if begin_s is None:
        observed = f"{at} contains {a_list([shorten(name) for name in strange])}, but there is no such target."
        text = "Remove a name when its turtle is caught, and add a name when the response from /spawn arrives."
        if strange[0] == "turtle1":
            text = "turtle1 drives to the targets, so it is not a target itself."
    elif begin_s > message.t_s:
        observed = f"{at} contains {shorten(strange[0])}, which did not exist before {begin_s:.1f} s."
        text = (
            "A turtle exists when the response from /spawn arrives. Add its name then, not when you send the request."
        )
        where = evidence.place("append", "publish")
    else:
        observed = f"{at} contains {shorten(strange[0])}, which no longer exists."
        text = "Remove a name from the list when its turtle is caught."
    return failed(observed, expected, Cause("still-announced", text, where))


def _is_of_parts(name: str, known: set[str]) -> bool:
    """Return whether a word of an announcement contains punctuation, or more than one name."""
    return NOT_IN_NAMES.search(name) is not None or sum(each in name for each in known) > 1


ANNOUNCES = Kind(
    "announces_targets",
    "trial",
    "The node announces the turtles",
    Announces,
    announces,
    about="The node regularly publishes a String with the names of all remaining turtles, separated by spaces.",
)
