"""Why an object is the wrong one: a message instead of its class, a subscription instead of a publisher, and so on."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.edit import at
from grader.common.words import a_list, shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene


def message_for_class(scene: CrashScene) -> Cause | None:
    """Return the cause if a publisher is created with a message instead of its class, else None."""
    for call in scene.evidence.code.calls("create_publisher"):
        given = call.argument(0, "msg_type")
        if isinstance(given, ast.Call):
            name = ast.unparse(given.func)
            text = f"create_publisher needs the class {shorten(name)} itself. A class name with () creates an object."
            fix = at(call.where, f"{ast.unparse(given)},", f"{name},")
            return Cause("object-for-class", text, call.where).fixed_by(fix)
    return None


def subscription_for_publisher(scene: CrashScene) -> Cause | None:
    """Return the cause if publish is called on a subscription and the node creates no publisher, else None."""
    calls = scene.evidence.code.calls
    if calls("create_publisher") or len(calls("create_subscription")) != 1:
        return None
    text = "A subscription only receives messages. Use create_publisher to send messages."
    return Cause("subscription-instead", text, calls("create_subscription")[0].where)


def set_twice(scene: CrashScene, name: str, text: str) -> Cause:
    """Return the cause of a missing attribute, with the lines that assign the object if there are several."""
    holders = [dotted(node.value) for node in scene.on_line if isinstance(node, ast.Attribute) and node.attr == name]
    for holder in filter(None, holders):
        lines = [
            node.lineno for node in scene.nodes if isinstance(node, ast.Assign) and holder in map(dotted, node.targets)
        ]
        if len(lines) > 1:
            more = (
                f"{shorten(holder)} is set in lines {a_list(list(map(str, sorted(lines))))}. Use one name per object."
            )
            return Cause("attribute-missing", f"{text} {more}", scene.at(max(lines)))
    return Cause("attribute-missing", text)
