"""Why a call was refused: TypeError and its like in a student's node."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.causes import ros_names
from grader.checks.causes.cause import Cause
from grader.checks.causes.crash_scene import attributes_set, methods
from grader.common.words import a_list, shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import Scene

MISSING = re.compile(r"(?:\w+\.)*(?P<function>\w+)\(\) missing \d+ required .*arguments?: (?P<names>.*)")
TOO_MANY = re.compile(
    r"(?:(?P<of>\w+)\.)?(?P<function>\w+)\(\) takes (?:from \d+ to )?\d+ positional arguments?"
    r" but \d+ (?:was|were) given"
)
KEYWORD = re.compile(r"(?:\w+\.)*(?P<function>\w+)\(\) got an unexpected keyword argument '(?P<name>\w+)'")
NOT_CALLABLE = re.compile(r"'(?P<type>\w+)' object is not callable")
EXPECTED = re.compile(r"Expected <class '[\w.]*\.(?P<wanted>\w+)'>, got <class '(?P<got>[\w.]+)'>")
TEXT_AND_NUMBER = re.compile(
    r"can only concatenate str|unsupported operand type\(s\) for \+|rcutils_log\(\): incompatible"
)
MAKERS = {"create_timer": 1, "create_subscription": 2, "create_service": 2}
"""Methods of a node that take a callback, and its place among the arguments."""
MAKE = "An object of it is made by parentheses behind its name."
WANTS = {
    "create_publisher": "the type, the topic and the queue size",
    "create_subscription": "the type, the topic, the method to call and the queue size",
    "create_timer": "the period and the method to call",
    "publish": "one message",
    "spin": "the node",
    "info": "one text",
}


def callback_called(scene: Scene) -> Cause | None:
    """A callback with parentheses behind it, on the line of the exception."""
    for name, place in MAKERS.items():
        for call in scene.calls_on_line(name):
            given = call.args[place] if len(call.args) > place else _keyword(call, "callback")
            if isinstance(given, ast.Call) and (dotted(given.func) or "").startswith("self."):
                text = f"{name} wants the method itself; with () behind its name it is called at once."
                return Cause("callback-called", text, scene.at(call))
    return None


def _keyword(call: ast.Call, name: str) -> ast.expr | None:
    return next((keyword.value for keyword in call.keywords if keyword.arg == name), None)


def swapped(scene: Scene) -> Cause | None:
    """Arguments of create_timer, create_publisher or create_subscription in another order."""
    for name in ("create_timer", "create_publisher", "create_subscription"):
        for call in scene.calls_on_line(name):
            kinds = [_kind(argument, scene) for argument in call.args]
            right = {"create_timer": ["number", "method"], "create_publisher": ["class", "text", "number"]}
            wanted = right.get(name, ["class", "text", "method", "number"])
            known = [kind for kind in kinds if kind]
            if len(known) == len(kinds) == len(wanted) and kinds != wanted and sorted(kinds) == sorted(wanted):
                return Cause("arguments-swapped", f"{name} wants, in this order: {WANTS[name]}.", scene.at(call))
    return None


def _kind(argument: ast.expr, scene: Scene) -> str:
    if isinstance(argument, ast.Constant):
        return "text" if isinstance(argument.value, str) else "number"
    name = dotted(argument) or ""
    own = [method.name for each in scene.classes for method in methods(each)]
    if name.startswith("self.") and name[len("self.") :] in own:
        return "method"
    return "class" if name[:1].isupper() else ""


def why_type(scene: Scene) -> Cause | None:
    """A call with too few, too many or the wrong arguments; something called that cannot be."""
    text = scene.crash.message
    found = callback_called(scene) or swapped(scene)
    if found is not None:
        return found
    missing, many, keyword = MISSING.search(text), TOO_MANY.search(text), KEYWORD.search(text)
    if missing is not None:
        return _too_few(scene, missing["function"], missing["names"])
    if many is not None:
        if many["function"] == "__init__" and many["of"] in ros_names.FIELDS:
            return Cause("message-arguments", "A message is made empty, and its fields are set after that, one by one.")
        return _too_many(scene, many["function"])
    if keyword is not None:
        more = f" It wants {WANTS[keyword['function']]}." if keyword["function"] in WANTS else ""
        return Cause("unexpected-keyword", f"{keyword['function']} knows no argument {keyword['name']}.{more}")
    if (expected := EXPECTED.search(text)) is not None:
        return _published(expected["wanted"], expected["got"])
    if (called := NOT_CALLABLE.search(text)) is not None:
        return _not_callable(scene, called["type"])
    return _by_its_words(scene, text)


def _by_its_words(scene: Scene, text: str) -> Cause | None:
    if "'property' object is not iterable" in text:
        spun = next(iter(scene.calls_on_line("spin")), None)
        name = ast.unparse(spun.args[0]) if spun is not None and spun.args else "It"
        text = f"rclpy.spin was handed {shorten(name)}, which is the class. {MAKE}"
        return Cause("class-for-object", text)
    if TEXT_AND_NUMBER.search(text):
        return Cause(
            "text-and-number", "A text and a number do not go together: an f-string writes a number into a text."
        )
    if "Expected QoSProfile or int" in text:
        return Cause("queue-size", "The last argument is the queue size, a whole number.")
    return None


def _too_few(scene: Scene, function: str, names: str) -> Cause:
    if function == "__init__" and "node_name" in names:
        return Cause("node-name-missing", "A node wants its name, a text, when super().__init__ makes it.")
    own = scene.functions(function)
    if own:
        text = f"Nobody fills in {shorten(names)}: a timer calls with nothing, a subscription with the message."
        return Cause("callback-parameters", text, scene.at(own[0]))
    if function in WANTS:
        return Cause("argument-missing", f"{function} wants {WANTS[function]}.")
    return Cause("argument-missing", f"{function} wants more than it gets: {shorten(names)}.")


def _too_many(scene: Scene, function: str) -> Cause | None:
    own = scene.functions(function)
    if own:
        first = [each.arg for each in (*own[0].args.posonlyargs, *own[0].args.args)][:1]
        inside = any(own[0] in methods(each) for each in scene.classes)
        if inside and first != ["self"]:
            return Cause("self-parameter", f"{function} is a method: its first parameter is self.", scene.at(own[0]))
        text = f"{function} has no parameter for what it is called with: a subscription hands over the message."
        return Cause("callback-parameters", text, scene.at(own[0]))
    if function in ros_names.OTHERS["RcutilsLogger"]:
        return Cause(
            "log-arguments", f"{function} takes one text, not several like print: an f-string puts all into one."
        )
    if function in WANTS:
        return Cause("too-many-arguments", f"{function} wants {WANTS[function]}, and nothing else.")
    return None


def _published(wanted: str, got: str) -> Cause:
    kind = got.rpartition(".")[2]
    if kind == f"Metaclass_{wanted}":
        return Cause("class-for-object", f"{wanted} is the class. {MAKE}")
    return Cause("publish-other", f"This publisher sends a whole {wanted}, and was handed a {shorten(kind)}.")


def _not_callable(scene: Scene, kind: str) -> Cause | None:
    for own in scene.classes:
        names = {each.name: each for each in methods(own)}
        for attribute, line in attributes_set(own):
            if attribute in names:
                text = f"self.{attribute} gets a value in line {line}, which hides the method of that name."
                return Cause("name-used-twice", text, scene.at(line))
    if kind == "NoneType":
        for name, place in MAKERS.items():
            for call in (node for node in scene.nodes if isinstance(node, ast.Call)):
                called = (dotted(call.func) or "").rpartition(".")[2] == name and len(call.args) > place
                if called and isinstance(call.args[place], ast.Call):
                    text = f"{name} wants the method itself; with () behind its name it gets only the method's result."
                    return Cause("callback-called", text, scene.at(call))
    return Cause("not-callable", f"The parentheses call something of the type {shorten(kind)}, which is no function.")


def why_refused(scene: Scene) -> Cause | None:
    """What rclpy itself refuses: names, parameters, a second init."""
    text = scene.crash.message
    if "must only be called once" in text:
        lines = [
            node.lineno for node in scene.nodes if isinstance(node, ast.Call) and dotted(node.func) == "rclpy.init"
        ]
        more = f" It stands in lines {a_list([str(line) for line in sorted(lines)])}." if len(lines) > 1 else ""
        return Cause("init-twice", f"rclpy.init belongs at one place of a program.{more}")
    if "called for existing topic name" in text:
        return Cause(
            "second-type", "A topic has one type: two publishers of different types on one name do not go together."
        )
    if "callback should be either be callable" in text:
        return callback_called(scene) or _no_message(scene)
    if "timer period must be non-negative" in text:
        return Cause("timer-period-negative", "A period is a time in seconds, so it is above 0.")
    return None


def _no_message(scene: Scene) -> Cause:
    for call in scene.calls_on_line("create_subscription"):
        name = (dotted(call.args[2]) or "").rpartition(".")[2] if len(call.args) > 2 else ""
        for method in scene.functions(name):
            if len(method.args.args) < 2:
                text = f"{name} has no parameter for the message that a subscription hands over."
                return Cause("callback-parameters", text, scene.at(method))
    return Cause("not-callable", "What should be called with each message is no function.")
