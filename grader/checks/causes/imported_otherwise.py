"""Explain a NameError for a name that the file imports, but with `as`, on a later line or inside another function."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.edit import at

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene


def imported_otherwise(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause if the file imports the name with `as`, too late or inside another function, else None."""
    imports = [node for node in scene.nodes if isinstance(node, ast.Import | ast.ImportFrom)]
    for node, alias in ((each, alias) for each in imports for alias in each.names):
        function, renamed = scene.function_around(node), alias.name == name and alias.asname not in (None, name)
        if not renamed and name != (alias.asname or alias.name.partition(".")[0]):
            continue
        if function is not None and function is not scene.function:
            text = (
                f"Line {node.lineno} imports {name} inside {function.name}, so the name does not exist in other "
                "functions. Import it at the top of the file."
            )
            return Cause("local-name", text, scene.at(node))
        if renamed:
            text = f"Line {node.lineno} imports {name} under the name {alias.asname}. Write {alias.asname}."
            return Cause("name-undefined", text).fixed_by(at(scene.crash.where, name, str(alias.asname)))
        if node.lineno > scene.line:
            return Cause("name-too-early", f"Line {node.lineno} imports {name}, after this line.")
    return None
