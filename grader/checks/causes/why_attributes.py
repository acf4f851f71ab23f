"""Explain an AttributeError in a student's node: why an attribute was missing, or why it could not be assigned."""

from __future__ import annotations

import ast
import math
import random
import re
import time
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes import no_entry_point, ros_names
from grader.checks.causes.attribute_of_none import attribute_of_none
from grader.checks.causes.attributes_of_class import (
    members,
    needs_itself,
    of_rclpy,
    of_super,
    uncalled_init,
    without_publish,
)
from grader.checks.causes.crash_scene import Function, attributes_set, methods
from grader.checks.causes.why_init_call import misspelt_init
from grader.checks.causes.why_no_field import why_no_field
from grader.checks.causes.why_not_set import compared
from grader.checks.causes.why_other_object import (
    CREATE_OBJECT,
    class_for_object,
    not_called,
    set_twice,
    subscription_for_publisher,
)
from grader.checks.edit import at
from grader.common.words import a_list, nearest, shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from collections.abc import Iterable

    from grader.checks.causes.crash_scene import CrashScene

NO_ATTRIBUTE = re.compile(
    r"(?:'(?P<object>\w+)' object|type object '(?P<type>\w+)'|module '(?P<module>[\w.]+)')"
    r" has no attribute '(?P<name>\w+)'"
)
OF_THE_NODE = re.compile(
    r"^(\w+) cannot be modified after node creation|property '(\w+)' of '\w+' object has no setter"
    r"|can't set attribute '(\w+)'"
)
"""Matches messages of rclpy, and of Python 3.10 to 3.14, about a property that cannot be assigned."""
PLAIN = {
    "str": "a string",
    "int": "an integer",
    "float": "a number",
    "bool": "True or False",
    "tuple": "a tuple (values with a comma between them)",
    "list": "a list",
    "dict": "a dictionary",
    "set": "a set",
}
"""Maps a built-in type to a phrase for a value of this type."""
MOST_LETTERS = 2
"""The maximum difference in length, in letters, between a name and the name suggested in its place."""
MODULES_READ = {"math": math, "time": time, "random": random}


def why_no_attribute(scene: CrashScene) -> Cause | None:
    """Return the cause of an AttributeError, depending on the type of the object, or None."""
    taken = OF_THE_NODE.search(scene.crash.message)
    if taken is not None:
        return _without_setter(scene, next(filter(None, taken.groups())))
    match = NO_ATTRIBUTE.search(scene.crash.message)
    if match is None:
        return None
    if match["object"] == "super":
        return of_super(scene, match["name"])
    name = scene.written(match["name"])
    if match["module"]:
        return _of_module(scene, match["module"], name)
    owner = match["object"] or match["type"]
    if owner in ("property", "function", "method", "builtin_function_or_method", "NoneType"):
        return _of_a_wrong_thing(scene, owner, name)
    if scene.class_named(owner) is not None:
        return (_of_own_type if match["type"] else _of_own_class)(scene, owner, name)
    if not match["type"] and scene.own_class is not None and _is_subclass_elsewhere(scene, owner, name):
        return _of_own_class(scene, scene.own_class.name, name)
    if match["type"] or owner.startswith("Metaclass_"):
        return _of_class_elsewhere(scene, owner.removeprefix("Metaclass_"), name)
    return _of_another_object(scene, owner, name)


def _without_setter(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause if the attribute is a property without a setter or belongs to every node, else None."""
    own = next((each for each in scene.functions(name) if "property" in map(dotted, each.decorator_list)), None)
    if own is not None:
        text = f"{name} is a property without a setter, so it cannot be assigned. Store the value under another name."
        return Cause("name-used-twice", text, scene.at(own))
    if not any(isinstance(node, ast.Attribute) and dotted(node) == f"self.{name}" for node in scene.on_line):
        return None
    return Cause("name-of-node", f"Every node already has an attribute named {name}. Choose another name.")


def _is_subclass_elsewhere(scene: CrashScene, owner: str, name: str) -> bool:
    """Return whether the node's code defines the class of the object, and no class in this code sets the attribute."""
    classes = [
        node for module in scene.evidence.code.modules for node in module.nodes if isinstance(node, ast.ClassDef)
    ]
    known = any(each.name == owner for each in classes)
    return known and not any(attribute == name for each in classes for attribute, _ in attributes_set(each))


def _of_another_object(scene: CrashScene, owner: str, name: str) -> Cause | None:
    """Return the cause if an rclpy object, a message or a plain value lacks the attribute, else None."""
    if name in ros_names.FIELDS.get(owner, ()):
        return Cause("message-field", f"This is a {owner} of another package, which has other fields.")
    if owner in ros_names.FIELDS:
        fields, package = ros_names.FIELDS[owner], ros_names.MODULE_OF[owner].partition(".")[0]
        guess = nearest(name, fields)
        more = f" Did you mean {guess}?" if guess else ""
        fix = at(scene.crash.where, name, guess) if guess else ()
        return Cause("message-field", f"A {owner} of {package} has {a_list(fields)}.{more}").fixed_by(fix)
    if owner in ros_names.OTHERS and name in ros_names.OF_ROS_1:
        return _of_ros_1(name)
    if (owner, name) == ("Subscription", "publish") and (instead := subscription_for_publisher(scene)) is not None:
        return instead
    if owner in ros_names.OTHERS:
        text = f"{owner} objects have no attribute or method with that name."
        return _misspelt(scene, name, ros_names.OTHERS[owner]) or set_twice(scene, name, text)
    if owner in ("int", "float") and name == "self":
        comma = Cause("comma-missing", "Separate two arguments with a comma, not with a dot.")
        return comma.fixed_by(at(scene.crash.where, ". self", ", self"))
    if owner in PLAIN and name == "executor":
        return Cause("crash", f"rclpy.spin needs the node, an object of your class. This value is {PLAIN[owner]}.")
    if owner in PLAIN:
        return Cause("attribute-missing", f"This value is {PLAIN[owner]}, which has no {shorten(name)}.")
    return why_no_field(owner, name)


def _of_class_elsewhere(scene: CrashScene, owner: str, name: str) -> Cause:
    """Return the reason why a class from another file lacks the attribute, perhaps because only its objects have it."""
    if owner in ros_names.FIELDS:
        return class_for_object(scene, owner, name)
    text = f"The class {shorten(owner)} has no constant or method with that name."
    return _misspelt(scene, name, ros_names.CONSTANTS.get(owner, ())) or Cause("attribute-missing", text)


def _of_module(scene: CrashScene, module: str, name: str) -> Cause | None:
    if scene.evidence.entry_point() == f"{module}:{name}":
        text = f"The entry point names {shorten(name)}, which the module {shorten(module)} does not contain."
        missing = Cause("entry-point-function", text, no_entry_point.line(scene.evidence))
        return no_entry_point.indented(scene.module_of(f"{module.replace('.', '/')}.py"), name) or missing
    place = {**ros_names.IN_RCLPY, **ros_names.MODULE_OF}.get(name, "")
    if place and (module == "rclpy" or place.startswith(f"{module}.")):
        return Cause("import-wrong-place", f"{name} is in the module {place}.")
    if module == "rclpy" and name in ros_names.OF_ROS_1:
        return _of_ros_1(name)
    if module == "rclpy" and name in ros_names.NODE:
        text = f"{name} is a method of the node, not a function of rclpy. In a method of the node, write self.{name}."
        return Cause("attribute-missing", text).fixed_by(at(scene.crash.where, f"rclpy.{name}", f"self.{name}"))
    known = ros_names.RCLPY if module == "rclpy" else dir(MODULES_READ[module]) if module in MODULES_READ else ()
    return _misspelt(scene, name, known) or Cause(
        "attribute-missing", f"The module {shorten(module)} does not contain this name."
    )


def _of_ros_1(name: str) -> Cause:
    return Cause("name-of-ros-1", f"{name} belongs to rospy, the Python library of ROS 1. {ros_names.OF_ROS_1[name]}")


def _misspelt(scene: CrashScene, name: str, known: Iterable[str]) -> Cause | None:
    known = [each for each in known if each != name]
    plain = {key: each for each in known for key in (each.lower().removeprefix("status_"), each.lower())}
    guess = plain.get(name.lower()) or nearest(
        name, [each for each in known if abs(len(each) - len(name)) <= MOST_LETTERS]
    )
    if guess is None:
        return None
    text = f"A similar name exists: {guess}. Compare the two names letter by letter, including upper and lower case."
    return Cause("attribute-misspelt", text).fixed_by(at(scene.crash.where, name, guess))


def _of_own_type(scene: CrashScene, owner: str, name: str) -> Cause:
    """Return the reason why a class in the student's file lacks the attribute, which perhaps only its objects have."""
    own = scene.class_named(owner)
    assert own is not None
    outside = next((each for each in scene.top_functions() if each.name == name), None)
    if outside is not None:
        text = f"{name} is outside the class. Indent {name} like the other methods."
        return Cause("method-outside-class", text, scene.at(outside))
    first = next((each for each in scene.top_functions() if "self" in [a.arg for a in each.args.args]), None)
    if first is not None and first.lineno > own.lineno:
        text = f"{first.name} is not indented, so the class ends above it. Indent {first.name} like the other methods."
        return Cause("method-outside-class", text, scene.at(first))
    if name in {attribute for attribute, _ in attributes_set(own)} or name in ros_names.NODE:
        return class_for_object(scene, owner, name)
    return _misspelt(scene, name, members(scene, own)) or Cause(
        "attribute-missing", f"The class {shorten(owner)} has no method or attribute with that name."
    )


def _of_a_wrong_thing(scene: CrashScene, owner: str, name: str) -> Cause | None:
    if owner == "property":
        made = next((node for node in scene.nodes if isinstance(node, ast.Assign) and _is_message(node.value)), None)
        what = "This line uses a class instead of an object."
        what = what if made is None else f"{shorten(ast.unparse(made.value))} is a class."
        return Cause("class-for-object", f"{what} {CREATE_OBJECT}", scene.at(made))
    if owner == "NoneType":
        return attribute_of_none(scene, name)
    return not_called(scene, name)


def _is_message(value: ast.expr) -> bool:
    return (dotted(value) or "").rpartition(".")[2] in ros_names.FIELDS


def _of_own_class(scene: CrashScene, owner: str, name: str) -> Cause:
    own = scene.class_named(owner)
    assert own is not None
    made = next((each for each in methods(own) if each.name == "__init__"), None)
    is_own = any(isinstance(node, ast.Attribute) and node.attr == name for node in scene.on_line)
    if name.startswith("_") and not name.startswith("__") and made is not None and not is_own:
        base = [node for node in ast.walk(made) if isinstance(node, ast.Call) and (_attr(node.func) == "__init__")]
        if not base and (uncalled := uncalled_init(made)) is not None:
            text = "super().__init__ is not called. Write parentheses after it, with the node name inside."
            return Cause("super-init-missing", text, scene.at(uncalled))
        if not base:
            text = "__init__ never calls super().__init__, which creates the node."
            line = f'{" " * made.body[0].col_offset}super().__init__("{scene.evidence.trial.node}")'
            first = scene.at(made.body[0])
            return Cause("super-init-missing", text, scene.at(made)).fixed_by(at(first, "", line))
        text = "super().__init__ creates the node. You cannot use the node before that line."
        return Cause("super-init-late", text)
    instead = compared(scene, name) or (_of_ros_1(name) if name in ros_names.CALLED_ON_A_NODE else None)
    if instead is not None:
        return instead
    lines = [line for attribute, line in attributes_set(own) if attribute == name]
    if scene.line in lines:
        return needs_itself(scene, name)
    if lines:
        text = f"self.{shorten(name)} is assigned on line {min(lines)}, which has not run yet."
        return misspelt_init(scene, own, lines) or Cause("attribute-too-early", text)
    return _never_set(scene, own, name)


def _never_set(scene: CrashScene, own: ast.ClassDef, name: str) -> Cause:
    if any(isinstance(each, ast.AugAssign) and dotted(each.target) == f"self.{name}" for each in scene.on_line):
        text = f"self.{shorten(name)} has not been assigned before this line, so there is no value to change."
        return Cause("attribute-too-early", text)
    compared = [each for each in scene.on_line if isinstance(each, ast.Expr) and isinstance(each.value, ast.Compare)]
    if compared:
        equals = Cause("equals", "== compares two values. = assigns a value to a name.", scene.at(compared[0]))
        return equals.fixed_by(at(equals.where, "==", "="))
    local = [node for node in ast.walk(own) if isinstance(node, ast.Name) and _is_store(node) and node.id == name]
    if local:
        text = (
            f"Line {local[0].lineno} assigns {name} without self, so {name} is not an attribute. "
            f"Write self.{name} there."
        )
        place = scene.at(local[0])
        return Cause("missing-self", text, place).fixed_by(at(place, name, f"self.{name}"))
    outside = next((each for each in scene.top_functions() if each.name == name), None)
    if outside is not None:
        text = f"{name} is outside the class. Indent {name} like the other methods."
        return Cause("method-outside-class", text, scene.at(outside))
    inside = next((each for method in methods(own) for each in ast.walk(method) if _is_function(each, name)), None)
    if inside is not None:
        text = f"{name} is indented too far: it is inside another method, so self.{name} does not exist."
        return Cause("method-in-method", text, scene.at(inside))
    if name in ros_names.NODE:
        text = (
            f"{own.name} is not derived from Node, so it has no method {name}. Write the base class in parentheses "
            "after the class name."
        )
        return Cause("attribute-missing", text, scene.at(own))
    if name in ros_names.OTHERS["RcutilsLogger"]:
        text = f"{name} is a method of the logger, and get_logger() returns the logger."
        return Cause("attribute-missing", text).fixed_by(at(scene.crash.where, f".{name}(", f".get_logger().{name}("))
    if name == "publish":
        return Cause("node-publishes", "A node has no method publish. Call publish on the publisher instead.")
    return (
        of_rclpy(scene, name)
        or _misspelt(scene, name, {*ros_names.NODE, *members(scene, own)} - without_publish(scene, own, name))
        or Cause(
            "attribute-missing", f"self.{shorten(name)} is never assigned, and the class has no method with that name."
        )
    )


def _is_store(node: ast.Name) -> bool:
    return isinstance(node.ctx, ast.Store)


def _is_function(node: ast.AST, name: str) -> bool:
    return isinstance(node, Function) and node.name == name


def _attr(function: ast.expr) -> str:
    return function.attr if isinstance(function, ast.Attribute) else ""
