"""Explain exceptions whose reason is an object of the wrong kind: a message, a class, a path or a called callback."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_calls import MAKERS
from grader.checks.causes.why_other_object import CREATE_OBJECT
from grader.common.words import shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

FORMAT = re.compile(r"unsupported format string passed to (?P<type>\w+)\.__format__")
UNHASHABLE = re.compile(r"unhashable type: '(?P<type>\w+)'")
NOT_ITERABLE = re.compile(r"'(?P<type>\w+)' object is not iterable")
BRACES = re.compile(r"unknown substitution: (?P<name>\{\w+\})")
SENDERS = {"call_async": "create_client", "call": "create_client", "send_goal_async": "ActionClient"}
"""Maps a method that sends a request or a goal to the function or class that creates its client."""
PATHS = frozenset({"PosixPath", "Path", "WindowsPath"})


def why_wrong_object(scene: CrashScene) -> Cause | None:
    """Return the cause if an object of the wrong kind was passed, formatted, or used as a key, else None."""
    return (
        _called_callback(scene)
        or _request(scene)
        or _formatted(scene)
        or _key(scene)
        or _braces(scene)
        or _reader(scene)
    )


def _called_callback(scene: CrashScene) -> Cause | None:
    """Return the cause if the method that crashed was called where it should be passed as a callback, else None."""
    name = scene.function.name if scene.function is not None else ""
    lines = {where.line for where in scene.crash.callers if where.file == getattr(scene.module, "file", None)}
    for node in scene.nodes:
        if not isinstance(node, ast.Call) or node.lineno not in lines:
            continue
        maker = getattr(node.func, "attr", "")
        place = MAKERS.get(maker, len(node.args))
        given = node.args[place] if len(node.args) > place else None
        called = isinstance(given, ast.Call) and dotted(given.func) == f"self.{name}"
        if called and not any(map(_returns_a_value, ast.walk(scene.function or node))):
            text = f"{maker} needs the method itself. With () after its name, the method is called immediately."
            return Cause("callback-called", text, scene.at(node))
    return None


def _returns_a_value(node: ast.AST) -> bool:
    """Return whether this is a return statement with a value, which may be the callback."""
    return isinstance(node, ast.Return) and node.value is not None


def _request(scene: CrashScene) -> Cause | None:
    """Return the cause if a client sends something other than its own request or goal, else None."""
    if scene.crash.error != "TypeError" or scene.crash.message:
        return None
    for sender, maker in SENDERS.items():
        for call in scene.calls_on_line(sender):
            client = dotted(call.func.value) if isinstance(call.func, ast.Attribute) else None
            kind = _type_of(scene, client, maker) if client is not None else None
            part = "Goal" if maker == "ActionClient" else "Request"
            if kind is None:
                continue
            without = next((node for node in scene.nodes if _is_class(node, call, f"{kind}.{part}")), None)
            if without is not None:
                return Cause("class-for-object", f"{kind}.{part} is a class. {CREATE_OBJECT}", scene.at(without))
            text = f"{client} has the type {shorten(kind)}, so {sender} needs an object of {shorten(kind)}.{part}."
            return Cause("service-type" if part == "Request" else "action-type", text, scene.at(call))
    return None


def _is_class(node: ast.AST, call: ast.Call, name: str) -> bool:
    """Return whether the node assigns this class to the variable that the call passes."""
    given = dotted(call.args[0]) if call.args else None
    assigned = isinstance(node, ast.Assign) and dotted(node.value) == name
    return assigned and isinstance(node, ast.Assign) and given in map(dotted, node.targets)


def _type_of(scene: CrashScene, client: str, maker: str) -> str | None:
    """Return the name of the type with which the client is created, or None."""
    for node in scene.nodes:
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call) and client in map(dotted, node.targets):
            made = (dotted(node.value.func) or "").rpartition(".")[2] == maker
            args = node.value.args[1:] if maker == "ActionClient" else node.value.args
            return dotted(args[0]) if made and args else None
    return None


def _formatted(scene: CrashScene) -> Cause | None:
    """Return the cause if an object that is not a number has a format such as .2f, else None."""
    found = FORMAT.search(scene.crash.message)
    if found is None:
        return None
    kind = found["type"]
    if kind == "NoneType":
        text = "A value in this line is None, which cannot have a format such as .2f or >10."
        return Cause("none-before-message", text)
    what = "a feedback message" if kind.endswith("_Feedback") else f"an object of type {shorten(kind)}"
    text = f"A value in this line is {what}. A format such as .2f or >10 needs a number or a string."
    return Cause("message-field", text)


def _key(scene: CrashScene) -> Cause | None:
    """Return the cause if an object cannot be the key of a dictionary, or is not a collection, else None."""
    hashed, looped = UNHASHABLE.search(scene.crash.message), NOT_ITERABLE.search(scene.crash.message)
    if hashed is not None and hashed["type"][:1].isupper():
        text = f"A {hashed['type']} cannot be the key of a dictionary or an item of a set. Use a name as the key."
        return Cause("message-field", text)
    if looped is not None and looped["type"] in PATHS and scene.calls_on_line("AnyReader"):
        return Cause("bag-reader", "AnyReader takes a list of paths. Write square brackets, even for one path.")
    if looped is not None and looped["type"] == "Pose":
        text = "This value is one Pose, but the line needs a collection, such as a dictionary of poses."
        return Cause("message-field", text)
    return None


def _braces(scene: CrashScene) -> Cause | None:
    """Return the cause if a topic or service name contains braces that were not replaced, else None."""
    found = BRACES.search(scene.crash.message)
    if found is None:
        return None
    text = f"The name contains {found['name']} itself. An f-string or the method format replaces the braces."
    return Cause("topic-name-invalid", text)


def _reader(scene: CrashScene) -> Cause | None:
    """Return the cause if AnyReader got a string, or is not open on the line of the crash, else None."""
    if scene.crash.error == "AnyReaderError" and "not open" in scene.crash.message:
        around = scene.nodes if scene.function is None else ast.walk(scene.function)
        blocks = [node for node in around if isinstance(node, ast.With)]
        text = "The bag is not open here. A with statement opens it: with AnyReader([path]) as reader."
        if any("AnyReader" in ast.unparse(item) for block in blocks for item in block.items):
            text = "The bag is open only inside the with block of AnyReader. Indent the lines that read the messages."
        return Cause("bag-reader", text)
    if "'str' object has no attribute 'exists'" in scene.crash.message and scene.calls_on_line("AnyReader"):
        return Cause("bag-reader", "AnyReader takes a list of Path objects, not of strings.")
    return None
