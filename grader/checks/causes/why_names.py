"""Explain a NameError in a student's node: the reason why a name was missing."""

from __future__ import annotations

import ast
import builtins
import keyword
import math
import random
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes import ros_names
from grader.checks.causes.bindings import bindings, names_bound
from grader.checks.causes.bound_elsewhere import as_parameter, bound_elsewhere, stores, without_value
from grader.checks.causes.comma_for_dot import comma_for_dot
from grader.checks.causes.crash_scene import attributes_set, methods
from grader.checks.causes.imported_otherwise import imported_otherwise
from grader.checks.causes.why_calls import callback_called
from grader.checks.causes.why_other_object import NEED_THE_NODE
from grader.checks.edit import Edit, at
from grader.common.words import a_list, nearest, shorten

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

NO_NAME = re.compile(r"name '(?P<name>\w+)' is not defined")
WELL_KNOWN = ("rclpy", "math", "time", "random", "os", "sys", "json", "threading", "datetime", "functools")
MEMBERS = {
    "math": frozenset(name for name in dir(math) if not name.startswith("_")),
    "rclpy": frozenset(ros_names.RCLPY) - {"node"},
    "time": frozenset({"sleep", "perf_counter", "monotonic"}),
    "random": frozenset(name for name in dir(random) if name.islower() and not name.startswith("_")),
}
"""Maps a module to those of its names that learners often use without the name of the module as a prefix."""
TAKE_A_STRING = {"__init__": 0, "create_node": 0, "create_publisher": 1, "create_subscription": 1, "create_client": 1}
"""Functions of rclpy that take the name of a node, topic or service, each with the position of this argument."""
CONSTANTS = {
    "true": "True",
    "false": "False",
    "none": "None",
    "null": "None",
    "TRUE": "True",
    "FALSE": "False",
}


def why_no_name(scene: CrashScene) -> Cause | None:
    """Return the cause of a NameError, such as a missing self or import, or a typo. Return None for other messages."""
    match = NO_NAME.search(scene.crash.message)
    if match is None:
        return None
    name = scene.written(match["name"])
    return (
        comma_for_dot(scene, name)
        or _in_callback(scene, name)
        or _of_base(scene, name)
        or _of_self(scene, name)
        or _of_string(scene, name)
        or _in_other_capitals(scene, name)
        or imported_otherwise(scene, name)
        or _of_interface(scene, name)
        or _of_import(scene, name)
        or _of_from_import(scene, name)
        or bound_elsewhere(scene, name)
        or _alike(scene, name)
        or _unknown(scene, name)
    )


def _unknown(scene: CrashScene, name: str) -> Cause:
    if known := [each for each in bindings(scene, name) if not each.in_brackets and each.line != scene.line]:
        return Cause("name-undefined", without_value(known[0]))
    if name in ("rospy", "actionlib"):
        return Cause("ros-1-module", f"{name} belongs to ROS 1. The Python library of ROS 2 is rclpy.")
    if name[:1].isupper():
        return Cause("name-undefined", "Nothing defines this name before this line, and nothing imports it.")
    parameter = as_parameter(scene, name)
    text = parameter or "Nothing defines this name before this line."
    for function in NEED_THE_NODE:
        if any(
            isinstance(each, ast.Name) and each.id == name
            for call in scene.calls_on_line(function)
            for each in call.args
        ):
            return Cause("name-undefined", f"{text} {function} needs the node, an object of your class.")
    if parameter:
        return Cause("local-name", text)
    may_be_string = _may_be_string(scene, name)
    return Cause("name-undefined", f"{text} A string needs quotation marks." if may_be_string else text)


def _may_be_string(scene: CrashScene, name: str) -> bool:
    """Return whether the name may be a string without its quotation marks.

    Such a name usually occurs only once. It has no attribute, is not called, and is not inside an f-string.
    """
    uses = [node for node in scene.nodes if isinstance(node, ast.Name) and node.id == name]
    others = [
        node.func if isinstance(node, ast.Call) else node.value
        for node in scene.on_line
        if isinstance(node, ast.Attribute | ast.FormattedValue | ast.Subscript | ast.Call)
    ]
    return len(uses) == 1 and uses[0] not in others


def _of_self(scene: CrashScene, name: str) -> Cause | None:
    if name == "self" and (scene.function is None or scene.own_class is None):
        return Cause(
            "self-parameter", "self exists only inside a method. Move this line into a method, such as __init__."
        )
    if name == "self":
        return Cause("self-parameter", "A method can use self only if self is its first parameter.")
    own = scene.own_class
    if own is None or (scene.function is None and name in _set_in_class(own)):
        return None
    known = {*(each.name for each in methods(own)), *(each for each, _ in attributes_set(own)), *_set_in_class(own)}
    if _of_string(scene, name) is not None and not _holds_string(own, name):
        return None
    if name in known or (name in ros_names.NODE and _is_called(scene, name)):
        text = f"{name} belongs to the object. Inside a method, write self.{name}."
        return Cause("missing-self", text).fixed_by(at(scene.crash.where, name, f"self.{name}"))
    return None


def _of_interface(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause if a part of a service or an action is created without the name of its type, else None."""
    if name not in ("Request", "Response", "Goal") or not _is_called(scene, name) or any(stores(scene, name)):
        return None
    of = "an action" if name == "Goal" else "a service"
    text = f"{name} is a part of {of}. Write the name of the type and a dot before it, as in TYPE.{name}()."
    return Cause("name-undefined", text)


def _in_callback(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause if the name is an argument of a callback that is called instead of passed, else None."""
    found = callback_called(scene)
    calls = [each for node in scene.on_line if isinstance(node, ast.Call) for each in (*node.args, *node.keywords)]
    given = [each.value if isinstance(each, ast.keyword) else each for each in calls]
    inside = [each for call in given if isinstance(call, ast.Call) for each in call.args]
    return found if any(isinstance(each, ast.Name) and each.id == name for each in inside) else None


def _of_base(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause if the name is a base class with a wrong first letter, as in `class Driver(node)`, else None."""
    bases = [base for each in scene.classes if each.lineno == scene.line for base in each.bases]
    others = [each for each in sorted(_bound(scene)) if each[:1].isupper() and each.lower() == name.lower()]
    other = others[0] if others and name[:1].islower() else None
    if other is None or not any(isinstance(each, ast.Name) and each.id == name for each in bases):
        return None
    text = f"A similar name exists: {shorten(other)}. Upper and lower case matter."
    return Cause("name-misspelt", text).fixed_by(at(scene.crash.where, name, other))


def _of_from_import(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause if the name is a package from which a line imports only other names, else None."""
    for node in scene.nodes:
        if isinstance(node, ast.ImportFrom) and not node.level and (node.module or "").partition(".")[0] == name:
            names = a_list([shorten(each.asname or each.name) for each in node.names])
            text = f"Line {node.lineno} gives the file {names}, but not the name {name}. Leave out the module here."
            if node.names[0].name != "*" and any(f"{node.module}." in ast.unparse(each) for each in scene.on_line):
                return Cause("name-undefined", text)
    return None


def _set_in_class(own: ast.ClassDef) -> set[str]:
    """Return the names that the body of the class assigns, outside its methods."""
    targets = [target for each in own.body if isinstance(each, ast.Assign) for target in each.targets]
    targets += [each.target for each in own.body if isinstance(each, ast.AnnAssign) and each.value is not None]
    return {target.id for target in targets if isinstance(target, ast.Name)}


def _of_string(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause if rclpy expects a string here (the name of a node, topic or service), else None."""
    for function, place in TAKE_A_STRING.items():
        for call in scene.calls_on_line(function):
            given = call.args[place] if len(call.args) > place else None
            if isinstance(given, ast.Name) and given.id == name not in ros_names.MODULE_OF:
                text = f"Here {function} expects a string, which needs quotation marks."
                return Cause("name-undefined", text).fixed_by(at(scene.at(given), name, f'"{name}"'))
    return None


def _holds_string(own: ast.ClassDef, name: str) -> bool:
    """Return whether __init__ may assign a string to the attribute: a constant string, or an unknown value."""
    values = [
        node.value
        for method in methods(own)
        for node in ast.walk(method)
        if method.name == "__init__"
        and isinstance(node, ast.Assign)
        and f"self.{name}" in [ast.unparse(each) for each in node.targets]
    ]
    return any(not isinstance(each, ast.Constant) or isinstance(each.value, str) for each in values)


def _is_called(scene: CrashScene, name: str) -> bool:
    return any(isinstance(call.func, ast.Name) for call in scene.calls_on_line(name))


def _of_import(scene: CrashScene, name: str) -> Cause | None:
    if any(each.is_import or (each.function is None and each.of_class is None) for each in bindings(scene, name)):
        return None
    if name in ros_names.MODULE_OF:
        module = ros_names.MODULE_OF[name]
        star = _star_import(scene, module)
        if star is not None:
            text = f"{name} is in the module {module}. This line imports the names of another module."
            return Cause("import-wrong-place", text, scene.at(star)).fixed_by(
                at(scene.at(star), f"from {star.module} ", f"from {module} ")
            )
        text = f"The file does not import {name}, which is in the module {module}."
        return Cause("missing-import", text).fixed_by(_import(scene, f"from {module} import {name}"))
    if name in WELL_KNOWN:
        text = f"The file does not import the module {name}."
        return Cause("missing-import", text).fixed_by(_import(scene, f"import {name}"))
    for module, members in MEMBERS.items():
        if name in members and not any(stores(scene, name)):
            if module in _imported(scene):
                text = f"{name} belongs to the module {module}. Write {module}.{name}."
                return Cause("module-prefix", text).fixed_by(at(scene.crash.where, name, f"{module}.{name}"))
            if module != "rclpy":
                text = f"The file does not import {name}, which is in the module {module}."
                return Cause("missing-import", text).fixed_by(_import(scene, f"from {module} import {name}"))
    return None


def _in_other_capitals(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause if an argument on the line is a local variable written with capital letters, else None."""
    passed = any(
        isinstance(argument, ast.Name) and argument.id == name
        for call in scene.on_line
        if isinstance(call, ast.Call)
        for argument in call.args
    )
    other = name.lower()
    if not passed or other == name or not any(function is scene.function for _, function in stores(scene, other)):
        return None
    text = f"A similar name exists: {other}. Upper and lower case matter."
    return Cause("name-misspelt", text).fixed_by(at(scene.crash.where, name, other))


def _star_import(scene: CrashScene, module: str) -> ast.ImportFrom | None:
    """Return an import with * from the module's package or from another module of this package, or None."""
    for node in scene.nodes:
        if isinstance(node, ast.ImportFrom) and node.module and node.names[0].name == "*":
            same_package = node.module.partition(".")[0] == module.partition(".")[0]
            if same_package and node.module != module:
                return node
    return None


def _import(scene: CrashScene, line: str) -> tuple[Edit, ...]:
    """Return the edit that inserts an import before the first import of the file, if the file has one."""
    places = [node.lineno for node in scene.nodes if isinstance(node, ast.Import | ast.ImportFrom)]
    where = scene.crash.where
    return (Edit(where.file, min(places), "", line),) if where is not None and places else ()


def _alike(scene: CrashScene, name: str) -> Cause | None:
    if name == "this":
        text = "Other languages use the name this for the object. A Python method uses the name self."
        return Cause("name-misspelt", text).fixed_by(at(scene.crash.where, "this", "self"))
    if name in CONSTANTS:
        text = f"In Python, the spelling is {CONSTANTS[name]}. Upper and lower case matter."
        return Cause("name-misspelt", text).fixed_by(at(scene.crash.where, name, CONSTANTS[name]))
    statements = [node.value for node in scene.nodes if isinstance(node, ast.Expr)]
    if any(isinstance(each, ast.Name) and each.id == name for each in statements):
        word = name.lower() if name.lower() in keyword.kwlist else nearest(name, keyword.kwlist, alike=0.8)
        if word is not None:
            text = f"A line that consists of one word is usually a keyword of Python. A similar keyword exists: {word}."
            return Cause("name-misspelt", text).fixed_by(at(scene.crash.where, name, word))
    bound = _bound(scene) - {name}
    guess = nearest(name, bound, alike=0.8) or next((each for each in bound if sorted(each) == sorted(name)), None)
    if guess is None and _is_called(scene, name):
        plain = {each.lower(): each for each in _bound(scene)}
        guess = plain.get(name.lower())
    elif guess is None and name[:1].isupper() and name.lower() in bound:
        guess = name.lower()
    if guess is not None:
        text = f"A similar name exists: {shorten(guess)}. Compare the two names letter by letter."
        return Cause("name-misspelt", text).fixed_by(at(scene.crash.where, name, guess))
    return None


def _imported(scene: CrashScene) -> set[str]:
    imports = [node for node in scene.nodes if isinstance(node, ast.Import)]
    return {alias.asname or alias.name.partition(".")[0] for node in imports for alias in node.names}


def _bound(scene: CrashScene) -> set[str]:
    names = {name for node in scene.nodes for name in names_bound(node)}
    names |= {node.arg for node in scene.nodes if isinstance(node, ast.arg)}
    return names | {name for name in dir(builtins) if name.islower()} | set(ros_names.MODULE_OF)
