"""Why an attribute is not set: a comparison is written where an assignment belongs."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.edit import at
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene


def compared(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause if the line of the crash is only a comparison of this attribute with ==, else None."""
    for node in scene.on_line:
        said = node.value if isinstance(node, ast.Expr) else None
        if isinstance(said, ast.Compare) and isinstance(said.ops[0], ast.Eq) and dotted(said.left) == f"self.{name}":
            fix = at(scene.crash.where, f"self.{name} ==", f"self.{name} =")
            return Cause("equals", "== compares two values. = gives a value to a name.").fixed_by(fix)
    return None
