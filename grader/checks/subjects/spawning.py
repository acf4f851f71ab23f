"""Checks of a node that spawns turtles, announces the remaining turtles, and removes the caught turtles."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed
from grader.checks.causes.waiting import waits_in_callback
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_killed import why_killed
from grader.checks.causes.why_rate import callbacks_of
from grader.checks.causes.why_silent import methods_of, why_nothing
from grader.checks.causes.why_unasked import why_unasked
from grader.checks.kind import Kind, number, string
from grader.checks.outcome import Finding, failed, passed
from grader.checks.subjects.services import calls_of, no_response
from grader.checks.tolerance import Band, unless_starved
from grader.common.words import a_list, count, shorten
from grader.evidence import activity
from grader.evidence.targets import announcements, is_there
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.evidence.targets import Announcement
    from grader.trial.observed import Call

LATE_S = 1.05
"""The maximum delay of an announcement (s): two periods of the topic."""
AT_ONCE_S = 0.1
"""The maximum time between the last announcement of a turtle and its removal (s)."""
OFTEN = 3
"""The maximum number of messages, as a multiple of the timer's messages. A node may also publish after each change."""
ALIKE_M = 0.01
"""Places that differ by less than this are the same (m)."""


@dataclass(frozen=True, kw_only=True)
class Spawns:
    """The number of turtles that the node spawns, the prefix of their names, and the range of their coordinates (m)."""

    turtles: float = number(at_least=1, about="The number of turtles that the node spawns.")
    name: str = string(
        "the beginning of a name",
        default="target",
        about="The prefix of the names of the turtles. A number follows the prefix.",
    )
    low_m: float = number(1.0, at_least=0, about="The smallest coordinate of a turtle.")
    high_m: float = number(10.0, at_least=0, about="The largest coordinate of a turtle.")


@dataclass(frozen=True, kw_only=True)
class PlacesDiffer:
    """The id of another trial in which the same node ran, and the prefix of its turtles' names."""

    other: str = string("the id of a trial", about="The id of another trial of the same node.")
    name: str = string("the beginning of a name", default="target", about="The prefix of the names of the turtles.")


@dataclass(frozen=True, kw_only=True)
class Announces:
    """The topic with the names of the remaining turtles, and the time between two messages (s)."""

    topic: str = string(
        "the full name of a topic", start="/", about="The topic on which the node announces the turtles."
    )
    period_s: float = number(0.5, above=0, about="The time between two messages.")


@dataclass(frozen=True, kw_only=True)
class Removes:
    """The trial calls `service` with a turtle's name, and the names of the remaining turtles arrive on `topic`."""

    service: str = string("the full name of a service", start="/", about="The service that the trial calls.")
    type: str = string(
        "a service type, as in turtlesim/srv/Kill", about="The type of the service. The request has the field `name`."
    )
    topic: str = string(
        "the full name of a topic", start="/", about="The topic with the names of the remaining turtles."
    )


def spawns(evidence: Evidence, params: Spawns) -> Finding:
    """The node spawned this many turtles with the right names, in different places on the field."""
    wanted = [f"{params.name}{index + 1}" for index in range(int(params.turtles))]
    expected = (
        f"The node spawns {count(len(wanted), 'turtle')}, {wanted[0]} to {wanted[-1]}, at random places. "
        f"x and y are from {params.low_m:g} to {params.high_m:g}."
    )
    calls = [call for call in calls_of(evidence) if not call.by_trial and call.service == "/spawn"]
    crash = crash_of(evidence)
    if not calls:
        if crash is not None:
            return crash_finding(evidence, crash, end_observed(evidence), expected)
        return failed("The node never called /spawn.", expected, why_unasked(evidence, "/spawn"))
    where = evidence.place("Request", "call_async")
    names = [str((call.response or {}).get("name", "")) for call in calls]
    there = [name for name in names if name]
    strange = [name for name in there if name not in wanted]
    if strange and not any(name.startswith(params.name) for name in strange):
        observed = f"The node spawned a turtle named {shorten(strange[0])}."
        return failed(observed, expected, Cause("target-name", "The name is a field of the request.", where))
    if len(there) != len(wanted) or strange:
        if crash is not None and len(there) < len(wanted):
            return crash_finding(evidence, crash, end_observed(evidence), expected)
        observed = f"The node spawned {count(len(there), 'turtle')}: {a_list([shorten(name) for name in there])}."
        text = ""
        if len(there) < len(calls):
            text = "turtlesim refused a name because another turtle already has it."
        elif len(there) > len(wanted):
            text = "Count the requests when you send them, because the responses arrive later."
        return failed(observed, expected, Cause("target-count", text, where))
    return _places(evidence, params, calls, expected) or passed(f"The node spawned {count(len(there), 'turtle')}.")


def _places(evidence: Evidence, params: Spawns, calls: list[Call], expected: str) -> Finding | None:
    where = evidence.code.assigned("x") or evidence.place("Request", "call_async")
    places = [(float(call.request["x"]), float(call.request["y"])) for call in calls]
    for call, place in zip(calls, places, strict=True):
        if not all(params.low_m <= each <= params.high_m for each in place):
            observed = f"{shorten(str(call.request['name']))} is at x={place[0]:.2f}, y={place[1]:.2f}."
            text = "The field is about 11 m wide, and a turtle at the edge is hard to reach."
            if place == (0.0, 0.0):
                text = "The fields x and y of a request are 0 until the node sets them."
            return failed(observed, expected, Cause("target-place", text, where))
    first = places[0]
    if len(places) > 1 and all(abs(x - first[0]) + abs(y - first[1]) < ALIKE_M for x, y in places):
        observed = f"All turtles are at x={first[0]:.2f}, y={first[1]:.2f}."
        text = "Draw new numbers for each turtle, for example with random.uniform."
        return failed(observed, expected, Cause("target-place", text, where))
    return None


def places_differ(evidence: Evidence, params: PlacesDiffer) -> Finding:
    """The places of the turtles differ from their places in another trial of the same node."""
    expected = "Each time the node is started, the turtles are at other places."
    now, before = (_spawned(each) for each in (evidence, evidence.from_trial(params.other)))
    if now and now[: len(before)] == before[: len(now)]:
        observed = f"The node was started twice, and {params.name}1 was at {_at(now[0])} both times."
        text = "Draw the places with random, but without random.seed, which makes the numbers the same each time."
        where = evidence.place("seed") if evidence.code.calls("seed") else evidence.place("Request")
        return failed(observed, expected, Cause("target-place", text, where))
    return passed(expected)


def _spawned(evidence: Evidence) -> list[tuple[float, float]]:
    """Return the places in the requests to /spawn (m)."""
    made = [call for call in calls_of(evidence) if not call.by_trial and call.service == "/spawn"]
    return [(float(call.request["x"]), float(call.request["y"])) for call in made]


def _at(place: tuple[float, float]) -> str:
    return f"x={place[0]:.2f}, y={place[1]:.2f}"


def announces(evidence: Evidence, params: Announces) -> Finding:
    """Each message on the topic contains the names of all remaining turtles, and no other names."""
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
        finding = _wrong_names(evidence, message, expected)
        if finding is not None:
            return finding
    times_s = [*(message.t_s for message in heard), activity.end_s(evidence.recording)]
    begin_s, longest_s = max(((at_s, later_s - at_s) for at_s, later_s in pairwise(times_s)), key=lambda gap: gap[1])
    most = Band.at_most(1.4 * params.period_s)
    if not most.holds(longest_s):
        observed = f"After the message at {begin_s:.1f} s, no message arrived for {longest_s:.1f} s."
        crash = crash_of(evidence)
        if crash is not None:
            return crash_finding(evidence, crash, end_observed(evidence), expected)
        cause = Cause("timer-period", "Publish in each call of the timer.", evidence.place("create_timer"))
        finding = failed(observed, expected, waits_in_callback(evidence) or cause, near_edge=most.near(longest_s))
        return unless_starved(finding, evidence.recording, off=longest_s - 1.4 * params.period_s, per_s=1.0)
    often = OFTEN * (times_s[-1] - times_s[0]) / params.period_s
    if len(heard) > max(often, OFTEN):
        observed = f"{len(heard)} messages arrived in {times_s[-1] - times_s[0]:.1f} s."
        cause = Cause("timer-period", "Publish in the callback of one timer.", evidence.place("create_timer"))
        return failed(observed, expected, cause)
    return passed("The node announces the remaining targets.", near_edge=most.near(longest_s))


def _wrong_names(evidence: Evidence, message: Announcement, expected: str) -> Finding | None:
    """Return the failed finding about an announcement that was wrong for more than a second, or None."""
    tracks = evidence.recording.tracks
    from_s, to_s = message.t_s - LATE_S, message.t_s
    where = evidence.place("publish")
    around = {track.turtle for track in tracks if is_there(track, from_s, to_s + AT_ONCE_S)}
    called = {str(call.request.get("name")) for call in calls_of(evidence) if call.by_trial and call.t_s <= to_s}
    throughout = {
        track.turtle
        for track in tracks
        if track.rows[0][0] <= from_s and (track.gone_s is None or track.gone_s > to_s + AT_ONCE_S)
    }
    at = f"The message at {message.t_s:.1f} s"
    strange = [name for name in message.names if name not in around]
    known = {track.turtle for track in tracks}
    if strange and any(part in name for name in strange for part in known | {"target"} if name not in known):
        text = 'The text consists of the names, separated by single spaces: " ".join(names).'
        return failed(f'{at} is "{shorten(message.text)}".', expected, Cause("target-format", text, where))
    if strange:
        text = "Remove a name when its turtle is caught, and add a name when the response of /spawn arrives."
        observed = f"{at} names {a_list([shorten(name) for name in strange])}, which does not exist."
        return failed(observed, expected, Cause("still-announced", text, where))
    missing = sorted(throughout - called - set(message.names))
    if missing:
        observed = f"{at} does not name {a_list([shorten(name) for name in missing])}."
        stuck = waits_in_callback(evidence)
        text = "Add the name of a turtle to the list in the callback that receives the response of /spawn."
        return failed(observed, expected, stuck or Cause("target-unannounced", text, where))
    return None


def removes(evidence: Evidence, params: Removes) -> Finding:
    """Exactly the turtles that the trial caught were removed. Calls with unknown names changed nothing."""
    expected = (
        f"When {params.service} is called, the node removes the turtle that the request names, "
        f"and no other turtle, with /kill."
    )
    calls = [call for call in calls_of(evidence) if call.by_trial and call.service == params.service]
    recording = evidence.recording
    for call in calls:
        name = str(call.request["name"])
        if call.response is None:
            return no_response(evidence, params.service, params.type, call, expected)
        track = next((each for each in recording.tracks if each.turtle == name), None)
        own = [each for each in calls_of(evidence) if not each.by_trial and each.t_s >= call.t_s]
        kills = [each for each in own if each.service == "/kill"]
        gone_s = track.gone_s if track is not None else None
        if track is not None and (gone_s is None or gone_s - call.t_s > LATE_S):
            return _not_killed(evidence, name, params.topic, kills, expected)
        others = [each for each in recording.tracks if each.gone_s is not None and each.turtle != name]
        wrong = [each for each in others if each.turtle not in {str(other.request["name"]) for other in calls}]
        if wrong:
            observed = f"{shorten(wrong[0].turtle)} was removed, although nobody caught it."
            return failed(observed, expected, why_killed(evidence, wrong[0], params.service))
    return passed(f"A call of {params.service} removes the turtle.")


def _not_killed(evidence: Evidence, name: str, topic: str, kills: list[Call], expected: str) -> Finding:
    crash = crash_of(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, end_observed(evidence), expected)
    where = _callback(evidence) or evidence.place("create_service")
    if kills:
        other = shorten(str(kills[0].request["name"]))
        observed = f"{name} was caught, and the node asked /kill to remove {other or 'a turtle without a name'}."
        text = "The name to remove is request.name, the field of the request that the callback receives."
        return failed(observed, expected, Cause("not-killed", text, where))
    heard = announcements(evidence.recording, topic)
    if heard and not any(name in message.names for message in heard):
        text = f"{name} was never announced. Perhaps {name} is not in the list of the remaining turtles."
        return failed(f"{name} was caught, but it still exists.", expected, Cause("target-unannounced", text, where))
    why = waits_in_callback(evidence) or why_unasked(evidence, "/kill")
    if why.diagnosis == "service-not-called":
        why = Cause("not-killed", "The callback of the service must send a request to /kill.", where)
    return failed(f"{name} was caught, but it still exists.", expected, why)


def _callback(evidence: Evidence) -> Where | None:
    """Return the place of the node's service callback."""
    names = {name for _, name in callbacks_of(evidence, "create_service")}
    return next(
        (Where(each.file, method.lineno) for each, method in methods_of(evidence) if method.name in names), None
    )


SPAWNS = Kind(
    "spawns_targets",
    "trial",
    "The node spawns turtles",
    Spawns,
    spawns,
    about="The node spawns a number of turtles with the right names, on the field and at different places.",
)
PLACES_DIFFER = Kind(
    "places_differ",
    "trial",
    "The places are random",
    PlacesDiffer,
    places_differ,
    about="The turtles are at other places than in the other trial of the same node.",
)
ANNOUNCES = Kind(
    "announces_targets",
    "trial",
    "The node announces the turtles",
    Announces,
    announces,
    about="The node regularly publishes a String with the names of all remaining turtles, separated by spaces.",
)
REMOVES = Kind(
    "removes_targets",
    "trial",
    "The node removes caught turtles",
    Removes,
    removes,
    about="The node removes each turtle that a `[[trial.call]]` names in its field `name`, and no other turtle.",
)
