"""=+ in place of +=, as in `self.ticks =+ 1`, which sets the counter to 1 in each call."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.edit import at
from grader.common.words import shorten
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.checks.diagnosis import Diagnosis
    from grader.evidence.evidence import Evidence


def sign_for_sum(evidence: Evidence, diagnosis: Diagnosis) -> Cause | None:
    """Return the cause if a method has =+ in place of +=, else None."""
    for module in evidence.code.modules:
        methods = (node for node in module.nodes if isinstance(node, ast.FunctionDef) and node.name != "__init__")
        for node in (node for method in methods for node in ast.walk(method) if isinstance(node, ast.Assign)):
            if isinstance(node.value, ast.UnaryOp) and isinstance(node.value.op, ast.UAdd):
                target, where = shorten(ast.unparse(node.targets[0]), 40), Where(module.file, node.lineno)
                text = f"=+ sets {target} to {shorten(ast.unparse(node.value.operand), 40)} in each call. += adds."
                return Cause(diagnosis, text, where).fixed_by(at(where, "=+", "+="))
    return None
