"""Find objects of the wrong kind, such as a message instead of its class, or a subscription instead of a publisher."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.crash_scene import attributes_set, methods
from grader.checks.edit import at
from grader.common.words import a_list, shorten
from grader.submission.constants import dotted
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene


NEED_THE_NODE = ("spin", "spin_once", "spin_until_future_complete", "add_node")
"""Functions of rclpy that take the node as an argument."""
CREATE_OBJECT = "Add parentheses after the class name to create an object."


def class_for_object(scene: CrashScene, owner: str, attribute: str) -> Cause:
    """Return the cause if the class `owner` is used like an object, with the line that assigns the class, if known."""
    text = f"{shorten(owner)} is a class. {CREATE_OBJECT}"
    used = [each for each in scene.on_line if isinstance(each, ast.Attribute) and each.attr == attribute]
    holders = {dotted(each.value) for each in used} - {owner}
    for node in scene.nodes:
        of_class = isinstance(node, ast.Assign) and (dotted(node.value) or "").rpartition(".")[2] == owner
        if isinstance(node, ast.Assign) and of_class and holders & {dotted(each) for each in node.targets}:
            return Cause("class-for-object", text, scene.at(node))
    return Cause("class-for-object", text)


def published_other(scene: CrashScene, wanted: str, got: str) -> Cause:
    """Return the cause if publish was called with something other than a message of the type `wanted`."""
    kind = got.rpartition(".")[2]
    if kind == f"Metaclass_{wanted}":
        return Cause("class-for-object", f"{wanted} is a class. {CREATE_OBJECT}")
    text = f"This publisher sends {wanted} messages, but publish was called with an object of type {shorten(kind)}."
    if kind == "NoneType":
        text = f"This publisher sends {wanted} messages, but publish was called with None."
        for call in scene.calls_on_line("publish"):
            maker = without_return(scene, call.args[0]) if call.args else None
            if maker is not None:
                return Cause("publish-other", f"{text} {maker.text}", maker.where)
    return Cause("publish-other", text)


def without_return(scene: CrashScene, call: ast.expr) -> Cause | None:
    """Return the cause if the expression calls one of the student's functions that returns nothing, else None."""
    name = (dotted(call.func) or "").rpartition(".")[2] if isinstance(call, ast.Call) else ""
    for module in scene.evidence.code.modules:
        for node in module.nodes:
            if isinstance(node, ast.FunctionDef) and node.name == name:
                if any(isinstance(each, ast.Return) and each.value for each in ast.walk(node)):
                    return None
                text = f"{name} has no return statement with a value, so it returns None."
                return Cause("publish-other", text, Where(module.file, node.lineno))
    return None


def no_object(scene: CrashScene) -> Cause:
    """Return the cause of a crash in spin or a similar function that was called with None instead of a node.

    The None may be the result of a function without a return statement.
    """
    calls = [call for name in NEED_THE_NODE for call in scene.calls_on_line(name) if call.args]
    function = (dotted(calls[0].func) if calls else None) or "rclpy.spin"
    text = f"{shorten(function)} was called with None instead of a node."
    given = {dotted(call.args[0]) for call in calls}
    for node in scene.nodes:
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call) and given & set(map(dotted, node.targets)):
            maker = without_return(scene, node.value)
            if maker is not None:
                return Cause("no-object", f"{text} {maker.text}", maker.where)
    return Cause("no-object", text)


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
    """Return the cause for a call to publish if the node has one subscription and no publisher, else None."""
    calls = scene.evidence.code.calls
    if calls("create_publisher") or len(calls("create_subscription")) != 1:
        return None
    text = "A subscription only receives messages. Use create_publisher to send messages."
    return Cause("subscription-instead", text, calls("create_subscription")[0].where)


def not_called(scene: CrashScene, name: str) -> Cause:
    """Return the reason why a function or a method lacks the attribute `name`.

    Perhaps its call has no parentheses, or a method has the same name as an attribute that is not assigned yet.
    """
    holders = {dotted(node.value) for node in scene.on_line if isinstance(node, ast.Attribute) and node.attr == name}
    for own in scene.classes:
        names = [each.name for each in methods(own)]
        for attribute, line in attributes_set(own):
            if attribute in names and f"self.{attribute}" in holders:
                text = (
                    f"self.{attribute} is still the method {attribute}: line {line}, which assigns self.{attribute}, "
                    "has not run yet. Use two names."
                )
                return Cause("name-used-twice", text, scene.at(line))
    return Cause("not-called", "The function is not called: the parentheses after its name are missing.")


def set_twice(scene: CrashScene, name: str, text: str) -> Cause:
    """Return the cause of a missing attribute, with the lines that assign the object if there are several.

    Assigning None does not count. A local variable is looked up only in its own function.
    """
    holders = [dotted(node.value) for node in scene.on_line if isinstance(node, ast.Attribute) and node.attr == name]
    for holder in filter(None, holders):
        inside = scene.nodes if "." in holder or scene.function is None else ast.walk(scene.function)
        made = [node for node in inside if isinstance(node, ast.Assign) and holder in map(dotted, node.targets)]
        lines = [node.lineno for node in made if ast.unparse(node.value) != "None"]
        if len(lines) > 1:
            more = (
                f"{shorten(holder)} is assigned on lines {a_list(list(map(str, sorted(lines))))}. "
                "Use one name per object."
            )
            return Cause("attribute-missing", f"{text} {more}", scene.at(max(lines)))
    return Cause("attribute-missing", text)
