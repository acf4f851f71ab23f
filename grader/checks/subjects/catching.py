"""Checks of a node that drives turtle1 to other turtles and requests the removal of each, nearest first."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash import crash_of, end_observed
from grader.checks.causes.why_again import why_again
from grader.checks.causes.why_condition import why_from_afar
from grader.checks.causes.why_crashed import crash_finding
from grader.checks.causes.why_killed import SAME_TIME_S, why_killed
from grader.checks.causes.why_not_caught import targets_were, why_not_caught
from grader.checks.causes.why_unasked import why_unasked
from grader.checks.kind import Kind, NoParams, number, string
from grader.checks.outcome import Finding, failed, passed
from grader.checks.starved import unless_starved
from grader.checks.subjects.services import calls_of
from grader.common.words import count, shorten
from grader.evidence import activity
from grader.evidence.interventions import KILL, RESET, moved_by
from grader.evidence.targets import caught, distance_m, is_there, moved_targets

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.trial.observed import Track
    from grader.trial.recording import Recording

NEARER_M = 0.5
"""A target counts as nearer than another one if the distances differ by more than this (m).

A smaller difference does not count, because the turtle moves while the node decides.
"""
SLACK_M = 0.1
"""The additional distance (m) that is allowed because a pose is slightly old when the node decides."""
OFTEN = 3
"""The maximum number of calls to the service for one target. A node may call again if a response is late."""


@dataclass(frozen=True, kw_only=True)
class Catches:
    """Requires that all targets are caught, and that there are at least `turtles` targets.

    `service` is the service that catches one target.
    """

    turtles: float = number(1, at_least=1, about="The minimum number of turtles, all of which must be caught.")
    service: str = string(
        "the full name of a service",
        default="",
        about="The service that must be called with the name of a turtle before this turtle is removed. Without this "
        "key, no call is required.",
    )


@dataclass(frozen=True, kw_only=True)
class WithinReach:
    """The service that removes a target, and the maximum distance (m) from which the node may call the service."""

    service: str = string("the full name of a service", start="/", about="The service that the node calls.")
    reach_m: float = number(above=0, about="The maximum distance of turtle1 from the target.")


def catches(evidence: Evidence, params: Catches) -> Finding:
    """At least `turtles` targets appeared, all were caught before SIGINT, and turtle1 moved only by driving.

    A target that the trial itself removed need not be caught. If `service` is set, each caught target must have been
    removed after a call to this service. The node may neither remove nor move the trial's own targets by itself.
    """
    recording = evidence.recording
    expected = f"All targets are caught within {recording.duration_s:g} s, and turtle1 moves only by driving."
    tracks = recording.tracks
    gone = caught(recording)
    moved = moved_by(recording, from_start=True, others_removed=True)
    if moved is not None:
        observed = f"The node moved the turtle with {moved}."
        text = "The turtle must drive to each target: publish on /turtle1/cmd_vel."
        return failed(observed, expected, Cause("not-driven", text, evidence.place("create_client", "ActionClient")))
    by_node = _without_driving(evidence)
    if by_node is not None:
        observed, text = by_node
        return failed(observed, expected, Cause("not-driven", text, evidence.place("create_client")))
    uncaught = _uncaught(recording, gone, params.service)
    if uncaught is not None:
        observed = f"{shorten(uncaught.turtle)} was removed at {uncaught.gone_s:.1f} s, although nobody caught it."
        other = next(iter(evidence.exercise.beside(evidence.trial.id)), evidence.trial)
        cause = why_killed(evidence.from_trial(other.id), uncaught, params.service)
        return failed(observed, expected, cause)
    left = [track for track in tracks if track not in gone and track.turtle not in recording.withdrawn]
    if not left and len(tracks) >= params.turtles:
        if len(tracks) == 1:
            return passed(f"The only target was caught at {gone[0].gone_s:.0f} s.")
        which = f"All {len(gone)}" if len(gone) == len(tracks) else "All remaining"
        return passed(f"{which} targets were caught, the last one at {gone[-1].gone_s:.0f} s.")
    crash = crash_of(evidence)
    if crash is not None:
        return crash_finding(evidence, crash, end_observed(evidence), expected)
    observed = f"{len(gone)} of {count(len(tracks), 'target')} {'was' if len(gone) == 1 else 'were'} caught."
    if len(tracks) < params.turtles:
        observed = f"{len(tracks)} of {count(int(params.turtles), 'target')} appeared."
    if end_observed(evidence):
        observed = f"{end_observed(evidence)} {observed}"
    finding = failed(observed, expected, why_not_caught(evidence, left))
    return unless_starved(finding, recording, off=0.1, per_s=1.0)


def _uncaught(recording: Recording, gone: list[Track], service: str) -> Track | None:
    """Return the first target that was removed before the service was called for it, or None."""
    if not service:
        return None
    asked_s: dict[object, float] = {}
    for call in recording.calls:
        if call.service == service:
            asked_s.setdefault(call.request.get("name"), call.t_s)
    late = (each for each in gone if asked_s.get(each.turtle, math.inf) > (each.gone_s or 0.0) + SAME_TIME_S)
    return next(late, None)


def _without_driving(evidence: Evidence) -> tuple[str, str] | None:
    """Return a sentence about how the node removed or moved targets by itself, with an explanation, else None.

    If the submission itself spawns the targets, it may move and remove them, so the result is None.
    """
    recording = evidence.recording
    if not evidence.trial.scenario.targets:
        return None
    text = "Only the spawner may remove a target. Call its service /catch."
    if RESET in recording.interventions:
        return "The node removed all targets itself, with /reset.", text
    if KILL in recording.interventions:
        killed = {call.request.get("name") for call in calls_of(evidence) if call.service == "/kill"}
        target = any(track.turtle in killed for track in recording.tracks)
        return "The node removed a target itself, with /kill." if target else "The node called /kill.", text
    moved = moved_targets(recording)
    if moved:
        text = "The turtle must drive to each target. Publish on /turtle1/cmd_vel only."
        return f"The node moved {shorten(moved[0].turtle)}, which is a target.", text
    return None


def nearest_first(evidence: Evidence, _: NoParams) -> Finding:
    """At the start and after each catch, the next caught target is the one that was nearest to turtle1 at that time."""
    recording = evidence.recording
    expected = "The next target is always the one nearest to turtle1."
    gone = caught(recording)
    if not gone:
        return failed("No target was caught.", expected, why_not_caught(evidence, list(recording.tracks)))
    from_s = 0.0
    for track in gone:
        others = [each for each in recording.tracks if is_there(each, from_s + 1e-6, from_s) and each is not track]
        found = min(others, key=lambda each: distance_m(recording, each, from_s), default=None)
        if found is not None and is_there(track, from_s + 1e-6, from_s):
            chosen_m, nearest_m = (distance_m(recording, each, from_s) for each in (track, found))
            if nearest_m < chosen_m - NEARER_M:
                return _other_order(evidence, track, chosen_m, found, nearest_m, from_s, gone, expected)
        from_s = track.gone_s or 0.0
    were = "was" if len(gone) == 1 else "were"
    return passed(f"{count(len(gone), 'target')} {were} caught, the nearest first.")


def _other_order(
    evidence: Evidence,
    track: Track,
    chosen_m: float,
    found: Track,
    nearest_m: float,
    from_s: float,
    gone: list[Track],
    expected: str,
) -> Finding:
    observed = (
        f"At {from_s:.1f} s, {shorten(found.turtle)} was {nearest_m:.1f} m away and {shorten(track.turtle)} "
        f"{chosen_m:.1f} m, but {shorten(track.turtle)} was caught first."
    )
    names = [each.turtle for each in gone]
    text = "After each catch, compute the distance from turtle1 to each remaining target again."
    recording = evidence.recording
    by_start = sorted(gone, key=lambda each: distance_m(recording, each, 0.0))
    farthest = max(recording.tracks, key=lambda each: distance_m(recording, each, 0.0))
    if len(names) > 1 and names == sorted(names):
        text = "The targets were caught in the order of their names."
    elif len(names) > 1 and [each.turtle for each in by_start] == names:
        text = (
            "The targets were caught in the order of their distances from the start. After each catch, turtle1 is "
            "in a different place."
        )
    elif gone[0] is farthest:
        text = "The first target was the farthest one."
    return failed(observed, expected, Cause("other-order", text, evidence.place("min", "sorted", "sort", "max")))


def within_reach(evidence: Evidence, params: WithinReach) -> Finding:
    """The node called the service only when turtle1 was near enough to the target, and not too often per target."""
    recording = evidence.recording
    expected = f"The node calls {params.service} when the target is at most {params.reach_m:g} m away."
    until = activity.end_s(recording)
    calls = [call for call in calls_of(evidence) if call.service == params.service and call.t_s < until]
    tracks = {track.turtle: track for track in recording.tracks}
    where = evidence.place("call_async")
    often = [name for name in tracks if sum(call.request["name"] == name for call in calls) > OFTEN]
    for call in calls:
        track = tracks.get(str(call.request["name"]))
        if track is None:
            observed = f'The node called {params.service} with the name "{shorten(str(call.request["name"]))}".'
            text = f"{targets_were(tracks)} The name is a field of the request."
            return failed(observed, expected, Cause("target-name", text, where))
        if track.gone_s is not None and track.gone_s < call.t_s:
            continue
        away_m = distance_m(recording, track, call.t_s)
        if not away_m <= params.reach_m + SLACK_M:
            observed = f"When the node called {params.service} for {track.turtle}, this turtle was {away_m:.2f} m away."
            why = why_from_afar(evidence, params.reach_m) or Cause("from-afar", "", where)
            return failed(observed, expected, why, near_edge=_near(away_m, params))
    if often:
        observed = f"The node called {params.service} for {often[0]} repeatedly."
        return failed(observed, f"{expected} One call is enough.", why_again(evidence))
    if not calls:
        return failed(f"The node never called {params.service}.", expected, why_unasked(evidence, params.service))
    unseen = _uncaught(recording, caught(recording), params.service)
    if unseen is not None:
        name = shorten(unseen.turtle)
        observed = f"{name} was removed, but the recording has no earlier call to {params.service} for it."
        text = "Did the node remove it without this call, or make more calls than a recording can hold?"
        return failed(observed, expected, Cause("catch-again", text, where))
    return passed(f"Each time the node called {params.service}, the target was near.")


def _near(away_m: float, params: WithinReach) -> bool:
    return math.isclose(away_m, params.reach_m + SLACK_M, abs_tol=0.02)


def waits_for_pose(evidence: Evidence, _: NoParams) -> Finding:
    """Before the first pose of turtle1, the node sent no velocity command except zeros."""
    first_s = evidence.trial.scenario.pose_from_s
    expected = "Until the first pose of turtle1 arrives, the turtle stands still."
    early = next((c for c in activity.commands(evidence.recording) if c.t_s < first_s and any(c.values)), None)
    if early is None:
        return passed("The turtle stood still until its first pose arrived.")
    observed = f"The node drove the turtle at {early.t_s:.1f} s. The first pose of turtle1 arrived at {first_s:.1f} s."
    text = "Before the first pose, the position of turtle1 is unknown. Store None until the first pose arrives."
    return failed(observed, expected, Cause("drives-before-pose", text, evidence.place("Pose", "publish")))


CATCHES = Kind(
    "catches_all",
    "trial",
    "All turtles are caught",
    Catches,
    catches,
    about="All turtles except turtle1 are removed before the end, and only velocity commands move turtle1. If the "
    "trial has `targets`, the node may neither remove nor move them itself.",
    drives=True,
)
NEAREST_FIRST = Kind(
    "nearest_first",
    "trial",
    "The nearest target is caught first",
    NoParams,
    nearest_first,
    about="At the start and after each catch, turtle1 drives to the turtle that is nearest at that moment.",
)
WITHIN_REACH = Kind(
    "within_reach",
    "trial",
    "The node catches a target only from nearby",
    WithinReach,
    within_reach,
    about="The node calls the service that removes a target, but only when turtle1 is near enough to this target, and "
    "not again and again.",
)
WAITS_FOR_POSE = Kind(
    "waits_for_pose",
    "trial",
    "The node waits for the first pose",
    NoParams,
    waits_for_pose,
    about="Before the first pose of turtle1, which the simulator publishes at `pose_from_s`, the node sends turtle1 no "
    "velocity commands, or only zeros.",
)
