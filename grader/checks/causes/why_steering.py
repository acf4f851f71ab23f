"""Explain from the source why a node that uses the pose does not drive where it should."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.waiting import functions_in_callbacks, has_threads, inside
from grader.submission.constants import dotted, evaluate
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module

LARGEST_RAD = 6.5
"""No angle that a program compares with theta is larger than this (rad): theta is between -pi and pi."""
COORDINATES = ("x", "y")


def why_steering(evidence: Evidence) -> Cause | None:
    """Return the cause if the source shows a mistake in how the node follows the pose, else None."""
    return _busy_loop(evidence) or _degrees(evidence) or _sideways(evidence)


def _nodes(evidence: Evidence) -> Iterator[tuple[Module, ast.AST]]:
    for module in evidence.code.modules:
        yield from ((module, node) for node in module.nodes)


def _busy_loop(evidence: Evidence) -> Cause | None:
    """Return the cause if a while loop in a callback publishes and reads an attribute such as self.pose, else None."""
    if has_threads(evidence):
        return None
    for module, function in functions_in_callbacks(evidence.code.modules):
        for node in inside(function):
            if isinstance(node, ast.While) and _publishes(node) and not _calls(node, "spin_once"):
                text = (
                    "This loop is in a callback. While it runs, a node with one thread receives no new pose. Publish "
                    "one command in each call, without a loop."
                )
                return Cause("loops-in-callback", text, Where(module.file, node.lineno))
    return None


def _publishes(loop: ast.While) -> bool:
    poses = any(isinstance(node, ast.Attribute) and "pose" in node.attr for node in ast.walk(loop))
    return poses and _calls(loop, "publish")


def _calls(node: ast.AST, name: str) -> bool:
    return any(isinstance(each, ast.Call) and getattr(each.func, "attr", "") == name for each in ast.walk(node))


def _degrees(evidence: Evidence) -> Cause | None:
    """Return the cause if the heading is compared with a number that is an angle in degrees, else None."""
    for module, node in _nodes(evidence):
        sides = [node.left, *node.comparators] if isinstance(node, ast.Compare) else []
        if any((dotted(side) or "").endswith(".theta") for side in sides):
            numbers = [number for side in sides if (number := _number(side, module)) is not None]
            if any(abs(number) > LARGEST_RAD for number in numbers):
                text = "theta is in radians, between -pi and pi, so it never reaches this value. Is it in degrees?"
                return Cause("degrees", text, Where(module.file, getattr(node, "lineno", None)))
    return None


def _number(side: ast.expr, module: Module) -> float | None:
    """Return the number that the expression has, or that is assigned to it first, or None."""
    value = evaluate(side, module.names)
    if value is None:
        targets = [node for node in module.nodes if isinstance(node, ast.Assign) and dotted(side)]
        given = next((node.value for node in targets if dotted(side) in map(dotted, node.targets)), None)
        value = evaluate(given, module.names) if given is not None else None
    return float(value) if isinstance(value, int | float) else None


def _sideways(evidence: Evidence) -> Cause | None:
    """Return the cause if linear.y is computed from a difference of coordinates, else None."""
    for module, node in _nodes(evidence):
        if not isinstance(node, ast.Assign) or not any(
            (dotted(each) or "").endswith("linear.y") for each in node.targets
        ):
            continue
        if any(isinstance(each, ast.BinOp) and isinstance(each.op, ast.Sub) for each in ast.walk(node.value)):
            text = (
                "linear.x and linear.y are speeds forwards and to the left of the turtle, not along x and y of the "
                "field. Turn to the goal with angular.z, and drive with linear.x."
            )
            return Cause("wrong-field", text, Where(module.file, node.lineno))
    return None


def theta_forgotten(evidence: Evidence) -> Cause | None:
    """Return the cause if the code computes a direction with atan2 but never reads theta, else None."""
    directions = evidence.code.calls("atan2")
    reads = any(isinstance(node, ast.Attribute) and node.attr == "theta" for _, node in _nodes(evidence))
    if not directions or reads:
        return None
    text = "The code never reads theta. The angle to turn by is the direction to the target minus theta."
    return Cause("turns-away", text, directions[0].where)


def compared_exactly(evidence: Evidence) -> Cause | None:
    """Return the cause if a coordinate of the pose is compared with == or !=, else None."""
    for module, node in _nodes(evidence):
        if not isinstance(node, ast.Compare) or not isinstance(node.ops[0], ast.Eq | ast.NotEq):
            continue
        if any(_is_coordinate(side) for side in (node.left, *node.comparators)):
            sign = "==" if isinstance(node.ops[0], ast.Eq) else "!="
            text = (
                f"This line compares a coordinate with {sign}, but the turtle hardly ever has exactly this coordinate. "
                "Compare the distance to the goal with a small number."
            )
            return Cause("goes-on", text, Where(module.file, node.lineno))
    return None


def _is_coordinate(side: ast.expr) -> bool:
    name = dotted(side) or ""
    return name.rpartition(".")[2] in COORDINATES and "pose" in name.lower()


def rounded_steps(evidence: Evidence) -> Cause | None:
    """Return the cause if the distance grows by rounded steps, or by a speed times a time, else None."""
    for module, node in _nodes(evidence):
        if not isinstance(node, ast.AugAssign) or not isinstance(node.op, ast.Add):
            continue
        where = Where(module.file, node.lineno)
        called = [getattr(each.func, "id", "") for each in ast.walk(node.value) if isinstance(each, ast.Call)]
        if {"round", "int"} & set(called):
            text = "Each step is rounded before it is added, so the errors add up. Round only when you log the sum."
            return Cause("wrong-distance", text, where)
        speeds = [each for each in ast.walk(node.value) if getattr(each, "attr", "") == "linear_velocity"]
        if speeds:
            text = (
                "linear_velocity is a speed, and it is negative when the turtle drives backwards. Add the distance "
                "from each pose to the next."
            )
            return Cause("wrong-distance", text, where)
    return None
