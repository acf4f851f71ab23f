"""Explain why a lifecycle node sends nothing: the node is never activated."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

LIFECYCLE = "LifecycleNode"
TRANSITIONS = ("on_activate", "on_configure")
"""Methods of a lifecycle node that run when another program requests a transition, the most important method first."""


def never_activated(evidence: Evidence) -> Cause | None:
    """Return the cause if a lifecycle node needs to be activated and does not activate itself, else None.

    A lifecycle node without the methods in TRANSITIONS and without lifecycle publishers works like any other node.
    The grader never activates a node, because in every exercise, the node must work as soon as it is started.
    """
    if evidence.code.calls("trigger_activate"):
        return None
    publishes = evidence.code.calls("create_lifecycle_publisher")
    for module in evidence.code.modules:
        for node in module.nodes:
            if isinstance(node, ast.ClassDef) and LIFECYCLE in [
                (dotted(b) or "").rpartition(".")[2] for b in node.bases
            ]:
                methods = {each.name: each.lineno for each in node.body if isinstance(each, ast.FunctionDef)}
                name = next((each for each in TRANSITIONS if each in methods), None)
                if not name and not publishes:
                    continue
                text = "A lifecycle node waits until it is activated, and nothing activates this node."
                more = f" So {name} is never called." if name else ""
                return Cause(
                    "method-never-called", text + more, Where(module.file, methods.get(name or "", node.lineno))
                )
    return None
