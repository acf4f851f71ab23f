"""Explain crashes of an entry point that names no plain function, and of a node that spins after the end of main."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.no_entry_point import line
from grader.checks.causes.why_ended import spins_in_a_thread
from grader.common.words import shorten
from grader.submission.code import module_file
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene
    from grader.evidence.evidence import Evidence

DESTROYED = re.compile(r"'NoneType' object has no attribute 'handle'|^InvalidHandle|cannot use Destroyable")
"""Matches exceptions in a thread that spins a node after the main thread has destroyed it."""
MISSING = re.compile(r"(?P<function>\w+)\(\) missing \d+ required positional arguments?: ")


def why_main(scene: CrashScene) -> Cause | None:
    """Return the cause if the entry point names a class, a coroutine or a function with parameters, else None.

    Also return the cause if the program ended while a thread was spinning the node.
    """
    file, named = _named(scene.evidence)
    if isinstance(named, ast.ClassDef) and scene.crash.error in ("NotInitializedException", "TypeError"):
        text = (
            f"The entry point {scene.evidence.trial.executable} names the class {shorten(named.name)}. It must name "
            "the function that calls rclpy.init, creates the node and spins it."
        )
        return Cause("entry-point-not-callable", text, line(scene.evidence))
    if DESTROYED.search(scene.crash.observed):
        return spins_in_a_thread(scene.evidence)
    asked = MISSING.search(scene.crash.message)
    if asked is not None and scene.crash.where is None and _is_entry(scene.evidence, asked["function"]):
        text = (
            f"The entry point {scene.evidence.trial.executable} names {shorten(asked['function'])}, which needs "
            "arguments. It must name a function that needs none, such as main."
        )
        return Cause("entry-point-not-callable", text, line(scene.evidence))
    # The script of an entry point passes the result of the function to sys.exit. A coroutine is not a number, so
    # Python prints it and ends with exit code 1.
    if isinstance(named, ast.AsyncFunctionDef) and scene.crash.error == "exit code 1":
        text = (
            f"{shorten(named.name)} is declared with async def, so calling it runs none of its lines. The function of "
            "an entry point begins with def."
        )
        return Cause("entry-point-not-callable", text, Where(file, named.lineno))
    return None


def _is_entry(evidence: Evidence, function: str) -> bool:
    """Return whether the entry point names this function, and the name of the function is not main."""
    return function != "main" and (evidence.entry_point() or "").partition(":")[2].strip() == function


def _named(evidence: Evidence) -> tuple[str, ast.stmt | None]:
    """Return the file that the entry point names, and the statement that defines its class or coroutine, or None."""
    name, _, attribute = (evidence.entry_point() or "").partition(":")
    file = module_file(name.strip(), evidence.submission.files) or ""
    body = next((module.body for module in evidence.code.modules if module.file == file), [])
    for node in body:
        if isinstance(node, ast.ClassDef | ast.AsyncFunctionDef) and node.name == attribute.strip():
            return file, node
    return file, None
