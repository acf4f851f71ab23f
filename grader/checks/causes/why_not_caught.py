"""Explain why some targets were not caught, for example because the turtle does not move, or stops too early."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_blocked import ANSWERS, why_blocked
from grader.checks.causes.why_not_reached import why_not_reached, wrong_turn
from grader.checks.causes.why_silent import calls_method, why_nothing
from grader.checks.causes.why_steering import theta_forgotten
from grader.checks.causes.why_unasked import why_unasked
from grader.common.lazy import np
from grader.common.words import a_list, shorten
from grader.evidence import activity
from grader.evidence.targets import distance_m
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Collection

    from grader.evidence.evidence import Evidence
    from grader.trial.observed import Track

STILL_S = 3.0
"""A turtle that has not moved for this time (s) is considered to stand still."""
STILL_M = 0.05
NEAR_M = 1.0
"""A turtle within this distance (m) of a target is considered to be near it."""
CATCH = "/catch"
OWN_POSE = "/turtle1/pose"
COMMANDS = "/turtle1/cmd_vel"
AT_ONCE = frozenset({"filter", "map", "reduce", "sorted", "min", "max"})
"""Functions that call their argument before the iteration of a loop ends, if their result is used there."""


def why_not_caught(evidence: Evidence, left: list[Track]) -> Cause:
    """Return the most likely reason why the targets in `left` were not caught."""
    recording = evidence.recording
    ended = [other for other in recording.beside if other.end.by == "itself"]
    if ended:
        text = f"{ended[0].executable} exited before all targets were caught, so the trial ended."
        other = next((spec for spec in evidence.exercise.beside(evidence.trial.id)), evidence.trial)
        return Cause("other-node-ended", text, evidence.from_trial(other.id).place("spin"))
    waiting = _no_target(evidence) or (None if _runs_until_end(evidence) else why_blocked(evidence))
    if waiting is not None:
        return waiting
    late = loop_variable(evidence)
    if late is not None:
        return late
    if not evidence.commands:
        silent = Cause("no-publish", "publish is never called.", evidence.place("create_publisher"))
        named = any(getattr(node, "attr", "") == "publish" for module in evidence.code.modules for node in module.nodes)
        why = why_nothing(evidence, ("publish",)) or (None if named else silent)
        return why or Cause("never-drives", _where_sent(evidence), evidence.place("create_publisher"))
    wrong = _wrong_name(evidence)
    if wrong is not None:
        return wrong
    if not _moved_m(evidence, 0.0):
        return _never_drives(evidence, left)
    if _moved_m(evidence, activity.end_s(recording) - STILL_S) <= STILL_M:
        return _stands_still(evidence, left)
    text = f"The turtle was still moving in the last {STILL_S:.0f} s of the trial."
    if left:
        near_m, name = min((_nearest_m(evidence, track), track.turtle) for track in left)
        known = why_not_reached(evidence, name, near_m)
        if known is not None:
            return known
        text += f" The turtle came within {near_m:.1f} m of {shorten(name)}." if np.isfinite(near_m) else ""
    return Cause("too-slow", text, evidence.place("publish"))


def _runs_until_end(evidence: Evidence) -> bool:
    """Return whether commands arrived until the end, but not from a loop, so no callback waits forever."""
    until = activity.end_s(evidence.recording) - STILL_S
    loops = [node for module in evidence.code.modules for node in module.nodes if isinstance(node, ast.While)]
    in_loop = any(calls_method(loop, "publish") for loop in loops)
    return not in_loop and any(command.t_s > until for command in evidence.commands)


def _where_sent(evidence: Evidence) -> str:
    """Return a sentence about a node whose commands did not arrive.

    If the node publishes on another topic whose name ends with /cmd_vel, the sentence names this topic.
    """
    found = activity.endpoints(evidence.recording, "publisher")
    topics = sorted({each.topic for each in found if each.topic.endswith("/cmd_vel")} - {COMMANDS})
    if not topics:
        return "No command arrived."
    return f"The node publishes on {shorten(topics[0])}, but turtle1 listens to {COMMANDS}."


def _no_target(evidence: Evidence) -> Cause | None:
    """Return the cause if the student's spawner, which runs in this trial, created no target, else None."""
    spawner = next(iter(evidence.exercise.beside(evidence.trial.id)), None)
    if evidence.recording.tracks or spawner is None:
        return None
    text = "The spawner created no target in this trial. A request is lost if it is sent before /spawn exists."
    return Cause("service-not-ready", text, evidence.from_trial(spawner.id).place("call_async"))


def _wrong_name(evidence: Evidence) -> Cause | None:
    """Return the cause if /catch was called with a name that no target has. Otherwise return None."""
    names = {track.turtle for track in evidence.recording.tracks}
    until = activity.end_s(evidence.recording)
    calls = [call for call in evidence.recording.calls if call.service == CATCH and call.t_s < until]
    strange = [name for call in calls if (name := str(call.request["name"])) not in names]
    if not strange:
        return None
    text = f'The node called {CATCH} with the name "{shorten(strange[0])}". {targets_were(names)}'
    return Cause("target-name", text, evidence.place("call_async"))


def targets_were(names: Collection[str]) -> str:
    """Return a sentence that names the targets, or says that there was none. It names at most 12 of them."""
    if not names:
        return "No target existed."
    listed = a_list([shorten(name) for name in sorted(names)])
    return f"{'The target was' if len(names) == 1 else 'The targets were'} {listed}."


def _never_drives(evidence: Evidence, left: list[Track]) -> Cause:
    subscriptions = activity.endpoints(evidence.recording, "subscription")
    poses = sorted({each.topic for each in subscriptions if each.topic.endswith("/pose")} - {OWN_POSE})
    wanted = [f"/{track.turtle}/pose" for track in left]
    if set(poses) & set(wanted):
        text = "linear.x is 0 in every command, so the turtle only turns."
        if not any(any(command.linear) or any(command.angular) for command in evidence.commands):
            text = "All commands that arrived contained only zeros."
        elif not any(command.linear[0] for command in evidence.commands):
            known = wrong_turn(evidence) or theta_forgotten(evidence)
            if known is not None:
                return known
        if any(command.linear[0] for command in evidence.commands):
            text = "Commands arrived, but the turtle stayed where it was."
        return Cause("never-drives", text, evidence.place("publish"))
    text = "The node does not subscribe to the pose of any target."
    if poses:
        topics = f": {a_list(wanted)}" if wanted else ""
        text = f"The node subscribes to {shorten(poses[0])}, but not to the pose of a target{topics}."
    return Cause("never-drives", text, evidence.place("create_subscription"))


def _nearest_m(evidence: Evidence, track: Track) -> float:
    """Return the smallest distance (m) from turtle1 to a target that was never caught, while the target existed."""
    x, y = track.rows[-1][1:3]
    frames = evidence.recording.frames
    rows = frames.t_s >= track.rows[0][0]
    return float(np.min(np.hypot(frames.x[rows] - x, frames.y[rows] - y), initial=np.inf))


def _stands_still(evidence: Evidence, left: list[Track]) -> Cause:
    recording = evidence.recording
    until = activity.end_s(recording)
    early = _called_too_early(evidence)
    if early is not None:
        return early
    for track in recording.tracks:
        if track.turtle in recording.withdrawn and distance_m(recording, track, until) <= NEAR_M:
            text = (
                f"The turtle stood where {shorten(track.turtle)} had been, but this target was no longer announced. "
                "In the callback of the topic, forget each target whose name is not in the message."
            )
            return Cause("not-forgotten", text, evidence.place("create_subscription"))
    near = min(left, key=lambda track: distance_m(recording, track, until), default=None)
    if near is not None and distance_m(recording, near, until) <= NEAR_M:
        asked = [call for call in recording.calls if call.service == CATCH and call.t_s < until]
        if not any(call.request["name"] == near.turtle for call in asked) and evidence.trial.scenario.targets:
            why = why_unasked(evidence, CATCH)
            if not asked:
                return why
        text = f"The turtle stood beside {shorten(near.turtle)} at the end."
        return Cause("stands-still", text, evidence.place("call_async", "publish"))
    text = (
        "The turtle stood still at the end. After a catch, the node must choose the nearest of the remaining targets."
    )
    return Cause("stands-still", text, evidence.place("call_async", "publish"))


def _called_too_early(evidence: Evidence) -> Cause | None:
    """Return the cause if turtle1 was near a target before /catch existed, and no call to /catch arrived, else None.

    The node must have code that calls the service, and no code that finds out whether the service exists.
    """
    recording = evidence.recording
    from_s = recording.catch_from_s
    sends = evidence.code.calls("call_async")
    if not from_s or not sends or any(evidence.code.calls(name) for name in ANSWERS):
        return None
    if any(call.service == CATCH for call in recording.calls):
        return None
    frames = recording.frames
    times = frames.t_s[frames.t_s <= from_s]
    if not any(distance_m(recording, each, t_s) <= NEAR_M for t_s in times for each in recording.tracks):
        return None
    text = (
        f"The turtle was near a target before {CATCH} existed, and no call arrived later. A request to a service that "
        "does not exist is lost. Before each call, use service_is_ready."
    )
    return Cause("service-not-ready", text, sends[0].where)


def _moved_m(evidence: Evidence, from_s: float) -> float:
    """Return the diagonal (m) of the smallest rectangle around the positions of turtle1 after this time."""
    frames = evidence.recording.frames
    rows = (frames.t_s >= from_s) & (frames.t_s <= activity.end_s(evidence.recording))
    if not rows.any():
        return 0.0
    return float(np.hypot(np.ptp(frames.x[rows]), np.ptp(frames.y[rows])))


def loop_variable(evidence: Evidence) -> Cause | None:
    """Return the cause if a function that is created in a loop uses the loop variable, else None.

    All functions that are created in the loop use the last value of the variable. A default value (`name=name`) keeps
    the value of each iteration. A function that is created just before the loop ends has the right value.
    """
    for module in evidence.code.modules:
        for loop in (node for node in module.nodes if isinstance(node, ast.For)):
            name = loop.target.id if isinstance(loop.target, ast.Name) else ""
            early = _called_at_once(loop) | _before_end(loop)
            for made in ast.walk(loop):
                if isinstance(made, ast.Lambda | ast.FunctionDef) and id(made) not in early and _uses(made, name):
                    text = (
                        f"The function is created in a loop and uses {shorten(name)}, the loop variable. When it is "
                        "called, the loop has ended, and the variable has its last value. Create it in a method that "
                        "takes the value as an argument."
                    )
                    return Cause("loop-variable", text, Where(module.file, made.lineno))
    return None


def _called_at_once(loop: ast.For) -> set[int]:
    """Return the ids of the functions that are called before the iteration ends, such as the key of min."""
    inside = list(ast.walk(loop))
    calls = [each for each in inside if isinstance(each, ast.Call)]
    passed = {id(each.value) for each in inside if isinstance(each, ast.keyword) and each.arg == "key"}
    passed |= {id(value) for each in calls if getattr(each.func, "id", "") in AT_ONCE for value in each.args}
    direct = {id(each.func) for each in calls} | passed
    kept = {each.id for each in inside if isinstance(each, ast.Name) and id(each) not in direct}
    return passed | {id(each) for each in inside if isinstance(each, ast.FunctionDef) and each.name not in kept}


def _before_end(loop: ast.For) -> set[int]:
    """Return the ids of the functions that are created in a block that ends the loop, with break or return."""
    found: set[int] = set()
    for node in ast.walk(loop):
        blocks = [node.body, node.orelse] if isinstance(node, ast.If | ast.For) else []
        for block in blocks:
            if block and isinstance(block[-1], ast.Break | ast.Return):
                found |= {id(each) for statement in block for each in ast.walk(statement)}
    return found


def _uses(made: ast.Lambda | ast.FunctionDef, name: str) -> bool:
    arguments = made.args
    if name in {each.arg for each in (*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs)}:
        return False
    body = [made.body] if isinstance(made, ast.Lambda) else made.body
    return any(isinstance(node, ast.Name) and node.id == name for part in body for node in ast.walk(part))
