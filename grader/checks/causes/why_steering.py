"""Explain from the source why a node that uses the pose does not drive where it should."""

from __future__ import annotations

import ast
from collections import Counter
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.callback_code import functions_in_callbacks, inside
from grader.checks.causes.waiting import has_threads
from grader.checks.causes.why_silent import calls_method, spins
from grader.submission.constants import dotted, number
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module

LARGEST_RAD = 6.5
"""A program has no reason to compare theta with a larger number (rad): theta is between -pi and pi."""
COORDINATES = ("x", "y")
GOALS = ("goal", "target")
"""Parts of the names that programs give to a goal."""
TO_DEGREES = ("degrees", "rad2deg")
ROTATES = ("sin", "cos", "exp", "rect")
"""Functions of the modules math, cmath and numpy that can rotate a vector."""
DIGITS = 3
"""Rounding a step to this number of decimal places, or to fewer, changes the distance."""


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
            if isinstance(node, ast.While) and _publishes(node) and not _lets_others_run(node):
                text = (
                    "This loop is in a callback. While it runs, a node with one thread receives no new pose. Publish "
                    "one command in each call, without a loop."
                )
                return Cause("loops-in-callback", text, Where(module.file, node.lineno))
    return None


def _publishes(loop: ast.While) -> bool:
    poses = any(isinstance(node, ast.Attribute) and "pose" in node.attr for node in ast.walk(loop))
    return poses and calls_method(loop, "publish")


def _lets_others_run(loop: ast.While) -> bool:
    """Return whether the loop spins the node, or awaits something: then other callbacks run meanwhile."""
    return spins(loop) or any(isinstance(node, ast.Await) for node in ast.walk(loop))


def _degrees(evidence: Evidence) -> Cause | None:
    """Return the cause if the heading is compared with a number that is an angle in degrees, else None."""
    if _sets_theta(evidence) or any(evidence.code.calls(name) for name in TO_DEGREES):
        return None
    assigned = _Assigned(evidence)
    for module, node in _nodes(evidence):
        sides = [node.left, *node.comparators] if isinstance(node, ast.Compare) else []
        if any((dotted(side) or "").endswith(".theta") for side in sides):
            values = [value for side in sides if (value := assigned.number(side, module)) is not None]
            if any(abs(value) > LARGEST_RAD for value in values):
                text = "theta is in radians, from -pi to pi, so it never reaches this value, which may be in degrees."
                return Cause("degrees", text, Where(module.file, getattr(node, "lineno", None)))
    return None


def _sets_theta(evidence: Evidence) -> bool:
    """Return whether the code sets an attribute theta, which may then be in degrees."""
    for _, node in _nodes(evidence):
        stores = isinstance(node, ast.Attribute) and node.attr == "theta" and isinstance(node.ctx, ast.Store)
        if stores or (isinstance(node, ast.keyword) and node.arg == "theta"):
            return True
    return False


class _Assigned:
    """What the code assigns to its variables and attributes. Names such as goal and self.goal count as one."""

    def __init__(self, evidence: Evidence) -> None:
        self.stores: Counter[str] = Counter()
        self.arguments: set[str] = set()
        self.values: dict[str, list[tuple[Module, ast.expr, ast.operator | None]]] = {}
        for module, node in _nodes(evidence):
            if isinstance(node, ast.arg):
                self.arguments |= {node.arg} - {"self"}
            if isinstance(getattr(node, "ctx", None), ast.Store):
                self.stores[_name(node)] += 1
            if isinstance(node, ast.Assign | ast.AnnAssign | ast.AugAssign) and node.value is not None:
                operator = node.op if isinstance(node, ast.AugAssign) else None
                for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
                    self.values.setdefault(_name(target), []).append((module, node.value, operator))

    def number(self, side: ast.expr, module: Module) -> float | None:
        """Return the constant value of the expression, or None.

        For a name that gets several values, return the value that is nearest to 0. All values must be constants, and an
        operator such as += must not bring the value nearer to 0.
        """
        if any(isinstance(each, ast.Name) and each.id in self.arguments for each in ast.walk(side)):
            return None
        name = _name(side)
        if not name or not self.stores[name]:
            return number(side, module.names)
        values, steps = [], []
        for other, given, operator in self.values.get(name, ()):
            value = number(given, other.names)
            if value is None or not isinstance(operator, ast.Add | ast.Sub | None):
                return None
            if operator is None:
                values.append(value)
            else:
                steps.append(value if isinstance(operator, ast.Add) else -value)
        if not values or len(values) + len(steps) < self.stores[name] or min(values) * max(values) <= 0.0:
            return None
        return None if any(step * values[0] < 0.0 for step in steps) else min(values, key=abs)


def _name(node: ast.AST) -> str:
    """Return the last part of the name of a variable or attribute, or "" for other nodes."""
    return getattr(node, "attr", getattr(node, "id", ""))


def _sideways(evidence: Evidence) -> Cause | None:
    """Return the cause if linear.y is computed from a difference that nothing rotates, else None."""
    if _reads_theta(evidence) and any(evidence.code.calls(name) for name in ROTATES):
        return None
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
    if not directions or _reads_theta(evidence):
        return None
    text = "The code never reads theta. The angle to turn by is the direction to the target minus theta."
    return Cause("turns-away", text, directions[0].where)


def _reads_theta(evidence: Evidence) -> bool:
    """Return whether the code may read theta. Setting it counts too: the action rotate_absolute gets a heading."""
    return any(isinstance(node, ast.Attribute) and node.attr == "theta" for _, node in _nodes(evidence))


def compared_exactly(evidence: Evidence) -> Cause | None:
    """Return the cause if a coordinate of the pose is compared with a goal by == or !=, else None."""
    for module, node in _nodes(evidence):
        if not isinstance(node, ast.Compare) or not isinstance(node.ops[0], ast.Eq | ast.NotEq):
            continue
        sides = (node.left, *node.comparators)
        if any(map(_is_coordinate, sides)) and any(_is_goal(side, module) for side in sides):
            sign = "==" if isinstance(node.ops[0], ast.Eq) else "!="
            text = (
                f"This line compares a coordinate with {sign}, but the turtle hardly ever has exactly this coordinate. "
                "Compare the distance to the goal with a small number."
            )
            return Cause("goes-on", text, Where(module.file, node.lineno))
    return None


def _is_coordinate(side: ast.expr) -> bool:
    """Return whether the expression is a coordinate of the turtle's pose. A name such as goal_pose names a goal."""
    name = (dotted(side) or "").lower()
    return name.rpartition(".")[2] in COORDINATES and "pose" in name and not any(word in name for word in GOALS)


def _is_goal(side: ast.expr, module: Module) -> bool:
    """Return whether the expression may be a coordinate of a goal: a positive constant, or a name as in GOALS."""
    value = number(side, module.names)
    return value > 0.0 if value is not None else any(word in ast.unparse(side).lower() for word in GOALS)


def rounded_steps(evidence: Evidence) -> Cause | None:
    """Return the cause if the distance grows by rounded steps, or by a speed times a time, else None."""
    for module, node in _nodes(evidence):
        if not isinstance(node, ast.AugAssign) or not isinstance(node.op, ast.Add):
            continue
        if "dist" not in ast.unparse(node.target).lower():
            continue
        where = Where(module.file, node.lineno)
        if _rounds(node.value, module):
            text = "Each step is rounded before it is added, so the errors add up. Round only when you log the sum."
            return Cause("wrong-distance", text, where)
        if _has_speed(node.value) and not any(
            _may_change_sign(each) and _has_speed(each) for each in ast.walk(node.value)
        ):
            text = (
                "linear_velocity is a speed, and it is negative when the turtle drives backwards. Add the distance "
                "from each pose to the next."
            )
            return Cause("wrong-distance", text, where)
    return None


def _rounds(value: ast.expr, module: Module) -> bool:
    """Return whether the expression is a call to int, or a call to round with few decimal places."""
    name = value.func.id if isinstance(value, ast.Call) and isinstance(value.func, ast.Name) else ""
    if name != "round" or not isinstance(value, ast.Call):
        return name == "int"
    digits = number(value.args[1], module.names) if len(value.args) > 1 else 0.0
    return not value.keywords and digits is not None and digits <= DIGITS


def _has_speed(node: ast.AST) -> bool:
    return any(isinstance(each, ast.Attribute) and each.attr == "linear_velocity" for each in ast.walk(node))


def _may_change_sign(node: ast.AST) -> bool:
    """Return whether the node is a call, a power or a conditional expression, which may remove a minus sign."""
    return isinstance(node, ast.Call | ast.IfExp) or (isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow))
