"""Explain why a node keeps running after Ctrl-C, if the source shows a reason."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.handlers import caught
from grader.checks.causes.waiting import waits_in_callbacks
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

CATCHES = frozenset({"KeyboardInterrupt", "BaseException"})
"""The exceptions whose except clause catches Ctrl-C."""
LEAVES = ast.Break | ast.Return | ast.Raise


def why_ignored(evidence: Evidence) -> Cause:
    """Return the reason why a node ignores Ctrl-C. The text of the cause is empty if the source shows no reason."""
    text, where = (
        _refuses(evidence)
        or _catches(evidence)
        or _loops(evidence)
        or _waits(evidence)
        or _threads(evidence)
        or ("", None)
    )
    return Cause("ignores-ctrl-c", text, where or evidence.place("spin", "init"))


def _refuses(evidence: Evidence) -> tuple[str, Where] | None:
    """Return the reason if the program tells the system to ignore SIGINT, else None."""
    for call in evidence.code.calls("signal"):
        signals = [(dotted(argument) or "").rpartition(".")[2] for argument in call.node.args]
        if signals == ["SIGINT", "SIG_IGN"]:
            return "With SIG_IGN, the program ignores SIGINT, which is the signal of Ctrl-C.", call.where
    return None


def _catches(evidence: Evidence) -> tuple[str, Where] | None:
    """Return the reason if an endless loop continues after an except clause that catches Ctrl-C, else None."""
    for file, loop in _endless_loops(evidence):
        for node in ast.walk(loop):
            if isinstance(node, ast.ExceptHandler) and caught(node) & CATCHES and not _leaves(node):
                text = f"This except clause catches Ctrl-C, and then the loop on line {loop.lineno} continues."
                return text, Where(file, node.lineno)
    return None


def _leaves(node: ast.AST) -> bool:
    """Return whether a statement in this part of the source may leave a loop or end the program."""
    nodes = list(ast.walk(node))
    calls = [dotted(each.func) or "" for each in nodes if isinstance(each, ast.Call)]
    ends = any(name.rpartition(".")[2] in ("exit", "quit", "_exit") for name in calls)
    return ends or any(isinstance(each, LEAVES) for each in nodes)


def _loops(evidence: Evidence) -> tuple[str, Where] | None:
    """Return the reason if a loop never ends, else None."""
    for file, loop in _endless_loops(evidence):
        if not _leaves(loop):
            return "This loop never ends, so it may keep the program running after Ctrl-C.", Where(file, loop.lineno)
    return None


def _endless_loops(evidence: Evidence) -> list[tuple[str, ast.While]]:
    """Return the loops whose condition is always true, with their files."""
    return [
        (module.file, node)
        for module in evidence.code.modules
        for node in module.nodes
        if isinstance(node, ast.While) and isinstance(node.test, ast.Constant) and node.test.value
    ]


def _waits(evidence: Evidence) -> tuple[str, Where] | None:
    """Return the reason if a callback waits forever, else None."""
    wait = next((each for each in waits_in_callbacks(evidence) if each.deadlock), None)
    return None if wait is None else ("A callback that waits forever keeps the program running.", wait.where)


def _threads(evidence: Evidence) -> tuple[str, Where] | None:
    """Return the reason if the program starts a thread that is not a daemon, else None."""
    nodes = [node for module in evidence.code.modules for node in module.nodes]
    if any(isinstance(node, ast.Attribute) and node.attr == "daemon" for node in nodes):
        return None
    for call in evidence.code.calls("Thread"):
        if call.argument(99, "daemon") is None:
            return "The program ends only after this thread has ended, because the thread is not a daemon.", call.where
    return None
