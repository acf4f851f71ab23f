"""Explain why a service callback raised an exception, or made rclpy raise one."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.why_other_object import without_return
from grader.checks.causes.why_rate import callbacks_of
from grader.checks.causes.why_silent import methods_of
from grader.checks.causes.why_wrong_object import SENDERS
from grader.common.words import shorten
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

DISPLAYS: dict[object, str] = {ast.Tuple: "a tuple", ast.List: "a list", ast.Dict: "a dictionary"}
"""Maps a kind of expression to a phrase for its value, which is never a response."""
OF_A_RESPONSE = re.compile(r"'\w+_Response' object has no attribute")


def why_response(scene: CrashScene) -> Cause | None:
    """Return the cause if a service callback does not return its response or has swapped parameters, else None."""
    servers = {name for _, name in callbacks_of(scene.evidence, "create_service")}
    # rclpy raises a TypeError without a message if a callback returns anything but a response, or if a client sends
    # anything but a request.
    sends = any(scene.calls_on_line(sender) for sender in SENDERS)
    no_response = scene.crash.error == "TypeError" and not scene.crash.message and not sends
    if not servers and no_response:
        return _lambda(scene)
    for module, method in methods_of(scene.evidence):
        where = Where(module.file, method.lineno)
        if method.name not in servers:
            continue
        first = method.args.args[1].arg if len(method.args.args) > 1 else ""
        if OF_A_RESPONSE.search(scene.crash.message) and first.startswith("res"):
            text = f"{method.name} gets the request first, and the response second."
            return Cause("arguments-swapped", text, where)
        if not no_response:
            continue
        returns = any(isinstance(node, ast.Return) and node.value is not None for node in ast.walk(method))
        if not returns:
            text = f"{method.name} returns nothing. The callback of a service must return its response."
            return Cause("response-not-returned", text, where)
        if wrong := _returned_instead(method) or _class_returned(method):
            text = f"{method.name} returns {wrong}. The callback of a service must return its response."
            return Cause("response-not-returned", text, where)
    return None


def _lambda(scene: CrashScene) -> Cause | None:
    """Return the cause if a lambda that is the callback of a service does not return a response, else None."""
    for call in scene.evidence.code.calls("create_service"):
        callback = call.argument(2, "callback")
        body = callback.body if isinstance(callback, ast.Lambda) else None
        if body is None:
            continue
        called = without_return(scene, body)
        if called is not None:
            text = f"{called.text} The callback of a service must return its response."
            return Cause("response-not-returned", text, called.where)
        if isinstance(body, ast.Constant) or type(body) in DISPLAYS:
            text = "This lambda returns no response. The callback of a service must return its response."
            return Cause("response-not-returned", text, call.where)
    return None


def _returned_instead(method: ast.FunctionDef | ast.AsyncFunctionDef) -> str:
    """Return a phrase for the returned value if it is the request, a constant or a collection, else an empty string."""
    returned = [node.value for node in ast.walk(method) if isinstance(node, ast.Return)]
    request = method.args.args[1].arg if len(method.args.args) > 1 else ""
    if any(isinstance(value, ast.Name) and value.id == request for value in returned):
        return f"the request ({shorten(request)})"
    for value in returned:
        if isinstance(value, ast.Call) and (dotted(value.func) or "").endswith("call_async"):
            return "the future of another request"
        if type(value) in DISPLAYS:
            return DISPLAYS[type(value)]
    return next((repr(value.value) for value in returned if isinstance(value, ast.Constant)), "")


def _class_returned(method: ast.FunctionDef | ast.AsyncFunctionDef) -> str:
    """Return a phrase for the class of the response if each return statement returns it, else an empty string."""
    returned = [node.value for node in ast.walk(method) if isinstance(node, ast.Return)]
    given = [node for node in ast.walk(method) if isinstance(node, ast.Assign) and len(node.targets) == 1]
    classes = {dotted(node.targets[0]): dotted(node.value) or "" for node in given}
    names = {dotted(value) or "" if value is not None else "" for value in returned}
    names = {classes.get(name, name) for name in names}
    name = names.pop() if len(names) == 1 else ""
    is_class = name[:1].isupper() and name.endswith(".Response") and isinstance(method.body[-1], ast.Return)
    return f"the class {shorten(name)} instead of an object" if is_class else ""
