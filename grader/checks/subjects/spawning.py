"""Checks of a node that spawns turtles and removes the caught turtles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed
from grader.checks.causes.why_blocked import why_blocked
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_ended import why_ended
from grader.checks.causes.why_killed import kill_request, why_killed
from grader.checks.causes.why_rate import callbacks_of
from grader.checks.causes.why_silent import methods_of
from grader.checks.causes.why_unasked import why_unasked
from grader.checks.kind import Kind, number, string
from grader.checks.outcome import Finding, Status, failed, passed
from grader.checks.subjects.announcing import LATE_S
from grader.checks.subjects.services import calls_of, no_response
from grader.common.words import a_list, count, shorten
from grader.evidence.targets import announcements
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.trial.observed import Call, Track

ALIKE_M = 0.01
"""Places that differ by less than this (m) count as the same place."""


@dataclass(frozen=True, kw_only=True)
class Spawns:
    """The number of turtles that the node spawns, the prefix of their names, and the range of their coordinates (m)."""

    turtles: float = number(at_least=1, about="The number of turtles that the node spawns.")
    name: str = string(
        "the beginning of a name",
        default="target",
        about="The prefix of the turtles' names. A number follows the prefix.",
    )
    low_m: float = number(1.0, at_least=0, about="The smallest allowed x or y of a turtle.")
    high_m: float = number(10.0, at_least=0, about="The largest allowed x or y of a turtle.")


@dataclass(frozen=True, kw_only=True)
class PlacesDiffer:
    """The id of another trial in which the same node ran, and the prefix of its turtles' names."""

    other: str = string("the id of a trial", about="The id of another trial of the same node.")
    name: str = string("the beginning of a name", default="target", about="The prefix of the turtles' names.")


@dataclass(frozen=True, kw_only=True)
class Removes:
    """The trial calls `service` with a turtle's name, and the names of the remaining turtles arrive on `topic`."""

    service: str = string("the full name of a service", start="/", about="The service that the trial calls.")
    type: str = string(
        "a service type, such as turtlesim/srv/Kill", about="The type of the service. The request has the field `name`."
    )
    topic: str = string(
        "the full name of a topic", start="/", about="The topic with the names of the remaining turtles."
    )


def spawns(evidence: Evidence, params: Spawns) -> Finding:
    """The node spawned the required turtles with the right names, in the allowed area and not all in one place."""
    wanted = [f"{params.name}{index + 1}" for index in range(int(params.turtles))]
    listed = wanted[0] if len(wanted) == 1 else f"{wanted[0]} to {wanted[-1]}"
    expected = (
        f"The node spawns {count(len(wanted), 'turtle')}, {listed}, in random places. "
        f"x and y are from {params.low_m:g} to {params.high_m:g}."
    )
    calls = _spawns(evidence)
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
        listed = f": {a_list([shorten(name) for name in there])}" if there else ""
        observed = f"The node spawned {count(len(there), 'turtle')}{listed}."
        text = ""
        if any(call.response is not None and not name for call, name in zip(calls, names, strict=True)):
            text = "turtlesim refused a name because another turtle already has it."
        elif len(there) > len(wanted):
            text = "Count the requests when you send them, because the responses arrive later."
            if len(there) == len(wanted) + 1 and len(set(there)) == len(there):
                text = "There is one request too many. Check the condition that limits the requests: should <= be <?"
        return failed(observed, expected, Cause("target-count", text, where))
    placed = [call for call, name in zip(calls, names, strict=True) if name]
    return _places(evidence, params, placed, expected) or passed(f"The node spawned {count(len(there), 'turtle')}.")


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
    expected = "Each time the node starts, the turtles are in different places."
    views = (evidence, evidence.from_trial(params.other))
    calls = [[call for call in _spawns(each) if str(call.request["name"]).startswith(params.name)] for each in views]
    if not all(calls):
        why = f"in at least one of the two trials, no turtle whose name begins with {shorten(params.name)} was spawned"
        return Finding(Status.SKIPPED, f"Not judged, because {why}.")
    now, before = ([(float(call.request["x"]), float(call.request["y"])) for call in made] for made in calls)
    if now[: len(before)] == before[: len(now)]:
        name = shorten(str(calls[0][0].request["name"]))
        observed = f"The node was started twice, and {name} was at {_at(now[0])} both times."
        text = "Draw the places with random, but without random.seed, which makes the numbers the same each time."
        where = evidence.place("seed") if evidence.code.calls("seed") else evidence.place("Request")
        return failed(observed, expected, Cause("target-place", text, where))
    return passed(expected)


def _spawns(evidence: Evidence) -> list[Call]:
    """Return the node's calls to /spawn."""
    return [call for call in calls_of(evidence) if not call.by_trial and call.service == "/spawn"]


def _at(place: tuple[float, float]) -> str:
    return f"x={place[0]:.2f}, y={place[1]:.2f}"


def removes(evidence: Evidence, params: Removes) -> Finding:
    """The node removed the turtles that the trial caught, and no others. Calls with unknown names changed nothing."""
    expected = (
        f"When {params.service} is called, the node calls /kill to remove the turtle whose name is in the request, and "
        "no other turtle."
    )
    calls = [call for call in calls_of(evidence) if call.by_trial and call.service == params.service]
    recording = evidence.recording
    if not calls:
        return no_response(evidence, params.service, params.type, None, expected)
    for call in calls:
        name = str(call.request["name"])
        if call.response is None:
            return no_response(evidence, params.service, params.type, call, expected)
        track = next((each for each in recording.tracks if each.turtle == name), None)
        own = [each for each in calls_of(evidence) if not each.by_trial and each.t_s >= call.t_s]
        kills = [each for each in own if each.service == "/kill"]
        gone_s = track.gone_s if track is not None else None
        if track is not None and (gone_s is None or gone_s - call.t_s > LATE_S):
            return _not_killed(evidence, track, call.t_s, params.topic, kills, expected)
        others = [each for each in recording.tracks if each.gone_s is not None and each.turtle != name]
        wrong = [each for each in others if each.turtle not in {str(other.request["name"]) for other in calls}]
        if wrong:
            observed = f"{shorten(wrong[0].turtle)} was removed, although nobody caught it."
            return failed(observed, expected, why_killed(evidence, wrong[0], params.service))
    return passed(f"A call to {params.service} removes the turtle.")


def _not_killed(
    evidence: Evidence, track: Track, caught_s: float, topic: str, kills: list[Call], expected: str
) -> Finding:
    name = track.turtle
    crash = crash_of(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, end_observed(evidence), expected)
    end = evidence.recording.end
    if end.by == "itself" and end.t_s <= caught_s + LATE_S:
        observed = f"{name} was caught, but it still exists. {end_observed(evidence)}"
        return failed(observed, expected, why_ended(evidence))
    where = _callback(evidence) or evidence.place("create_service")
    if track.gone_s is not None:
        observed = f"{name} was removed too late: {track.gone_s - caught_s:.1f} s after it was caught."
        return failed(observed, expected, why_blocked(evidence) or Cause("not-killed", "", where))
    others = [str(kill.request["name"]) for kill in kills if kill.request["name"] != name]
    if others:
        other = shorten(others[0])
        observed = f"{name} was caught, but the node called /kill for {other or 'a turtle without a name'}."
        text = "The name to remove is request.name, the field of the request that the callback receives."
        return failed(observed, expected, Cause("not-killed", text, where))
    heard = announcements(evidence.recording, topic)
    if heard and not any(name in message.names for message in heard):
        text = f"{name} was never announced. Perhaps {name} is not in the list of the remaining turtles."
        return failed(f"{name} was caught, but it still exists.", expected, Cause("target-unannounced", text, where))
    before = [message for message in heard if message.t_s < caught_s]
    if not any(call.service == "/kill" for call in calls_of(evidence)) and kill_request(evidence) is None:
        text = "The callback of the service must send a request to /kill."
        return failed(f"{name} was caught, but it still exists.", expected, Cause("not-killed", text, where))
    if before and name not in before[-1].names:
        text = f"The message before the call did not contain {name}. Was {name} removed from the list too early?"
        return failed(f"{name} was caught, but it still exists.", expected, Cause("target-unannounced", text, where))
    killed = [call for call in calls_of(evidence) if call.service == "/kill" and call.t_s < caught_s]
    if killed:
        text = (
            f"The node called /kill for {shorten(str(killed[-1].request['name']))}, but not for {name}. Was {name} "
            "still in the list of the remaining turtles?"
        )
        return failed(f"{name} was caught, but it still exists.", expected, Cause("target-unannounced", text, where))
    why = why_blocked(evidence) or why_unasked(evidence, "/kill")
    if why.diagnosis in ("service-not-called", "service-not-ready"):
        why = Cause("not-killed", "The callback of the service must send a request to /kill.", where)
    return failed(f"{name} was caught, but it still exists.", expected, why)


def _callback(evidence: Evidence) -> Where | None:
    """Return the place of the node's service callback, or None."""
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
    about="The node spawns the given number of turtles with the right names in the allowed area, not all in one place.",
)
PLACES_DIFFER = Kind(
    "places_differ",
    "trial",
    "The places are random",
    PlacesDiffer,
    places_differ,
    about="The turtles are not in the same places as in the other trial of the same node.",
)
REMOVES = Kind(
    "removes_targets",
    "trial",
    "The node removes caught turtles",
    Removes,
    removes,
    about="The node removes each turtle whose name is in the field `name` of a `[[trial.call]]`, and no other turtle.",
)
