"""Explain why an attribute or a field is not set: a comparison is written where an assignment belongs."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.edit import at
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene
    from grader.evidence.evidence import Evidence


EQUALS = "== compares two values. = assigns a value to a name."


def compared_field(evidence: Evidence, field: str) -> Cause | None:
    """Return the cause if a line only compares this field of a message, such as "linear.x", with ==, else None."""
    for module in evidence.code.modules:
        for node in module.nodes:
            said = node.value if isinstance(node, ast.Expr) else None
            if not isinstance(said, ast.Compare) or not isinstance(said.ops[0], ast.Eq):
                continue
            if (dotted(said.left) or "").endswith(f".{field}"):
                place = Where(module.file, said.lineno)
                return Cause("equals", EQUALS, place).fixed_by(at(place, f"{field} ==", f"{field} ="))
    return None


def compared_condition(evidence: Evidence) -> Cause | None:
    """Return the cause if a line only compares an attribute with ==, and a condition uses this attribute, else None."""
    for module in evidence.code.modules:
        tests = [node.test for node in module.nodes if isinstance(node, ast.If | ast.While)]
        used = {dotted(each) for test in tests for each in ast.walk(test) if isinstance(each, ast.Attribute)}
        for node in module.nodes:
            said = node.value if isinstance(node, ast.Expr) else None
            if isinstance(said, ast.Compare) and isinstance(said.ops[0], ast.Eq) and dotted(said.left) in used - {None}:
                place = Where(module.file, said.lineno)
                return Cause("equals", EQUALS, place).fixed_by(at(place, "==", "="))
    return None


def compared(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause if the line of the crash is only a comparison of this attribute with ==, else None."""
    for node in scene.on_line:
        said = node.value if isinstance(node, ast.Expr) else None
        if isinstance(said, ast.Compare) and isinstance(said.ops[0], ast.Eq) and dotted(said.left) == f"self.{name}":
            fix = at(scene.crash.where, f"self.{name} ==", f"self.{name} =")
            return Cause("equals", EQUALS).fixed_by(fix)
    return None
