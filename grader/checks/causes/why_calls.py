"""Explain a TypeError in a student's node, such as a call with wrong arguments."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes import ros_names
from grader.checks.causes.crash_scene import attributes_set, methods
from grader.checks.causes.why_ended import named_only
from grader.checks.causes.why_init_call import why_init_call
from grader.checks.causes.why_maker_call import why_maker_call
from grader.checks.causes.why_operands import why_operands
from grader.checks.causes.why_other_object import CREATE_OBJECT, message_for_class, published_other
from grader.checks.causes.why_parameters import too_few, too_many
from grader.checks.edit import at
from grader.common.words import count, shorten
from grader.submission.constants import dotted

if TYPE_CHECKING:
    from grader.checks.causes.crash_scene import CrashScene

MISSING = re.compile(r"(?:(?P<of>\w+)\.)*(?P<function>\w+)\(\) missing \d+ required .*arguments?: (?P<names>.*)")
TOO_MANY = re.compile(
    r"(?:(?P<of>\w+)\.)?(?P<function>\w+)\(\) takes (?:from \d+ to )?(?P<most>\d+) positional arguments?"
    r" but (?P<given>\d+) (?:was|were) given"
)
KEYWORD = re.compile(r"(?:\w+\.)*(?P<function>\w+)\(\) got an unexpected keyword argument '(?P<name>\w+)'")
NOT_CALLABLE = re.compile(r"'(?P<type>\w+)' object is not callable")
EXPECTED = re.compile(r"Expected <class '[\w.]*\.(?P<wanted>\w+)'>, got <class '(?P<got>[\w.]+)'>")
INNER = re.compile(r"_(?:Request|Response|Goal|Result|Feedback)$")
"""Matches the end of the name of a class that belongs to a service or to an action."""
LOGGED = "rcutils_log(): incompatible"
"""The beginning of rclpy's message about a log method that got something other than a string."""
MAKERS = {
    "create_timer": 1,
    "create_subscription": 2,
    "create_service": 2,
    "add_done_callback": 0,
    "add_on_set_parameters_callback": 0,
}
"""Maps a method that takes a callback to the position of the callback among the arguments."""
TAKES = {
    "create_publisher": "the type, the topic and the queue size",
    "create_subscription": "the type, the topic, the callback and the queue size",
    "create_timer": "the period and the callback",
    "publish": "one message",
    "spin": "the node",
    "info": "one string",
}
"""Maps a function to a phrase for the arguments that it needs in a beginner's program."""


def callback_called(scene: CrashScene) -> Cause | None:
    """Return the cause if a callback on the line of the exception has parentheses after its name, else None."""
    for name, place in MAKERS.items():
        for call in scene.calls_on_line(name):
            given = call.args[place] if len(call.args) > place else _keyword(call, "callback")
            if isinstance(given, ast.Call) and (dotted(given.func) or "").startswith("self."):
                text = f"{name} needs the method itself. With () after its name, the method is called immediately."
                fix = at(scene.at(given), f"{ast.unparse(given.func)}()", ast.unparse(given.func))
                return Cause("callback-called", text, scene.at(call)).fixed_by(fix)
    return None


def _keyword(call: ast.Call, name: str) -> ast.expr | None:
    return next((keyword.value for keyword in call.keywords if keyword.arg == name), None)


RIGHT_ORDER = {
    "create_timer": ["number", "method"],
    "create_publisher": ["class", "string", "number"],
    "create_subscription": ["class", "string", "method", "number"],
}
"""Maps a method to the kinds of its arguments, in the right order."""


def swapped(scene: CrashScene) -> Cause | None:
    """Return the cause if create_timer, create_publisher or create_subscription has swapped arguments, else None."""
    for name, wanted in RIGHT_ORDER.items():
        for call in scene.calls_on_line(name):
            kinds = [kind_of(argument, scene) for argument in call.args]
            known = [kind for kind in kinds if kind]
            if len(known) == len(kinds) == len(wanted) and kinds != wanted and sorted(kinds) == sorted(wanted):
                text = f"{name} takes its arguments in this order: {TAKES[name]}."
                return Cause("arguments-swapped", text, scene.at(call))
    return None


def kind_of(argument: ast.expr, scene: CrashScene) -> str:
    """Return "string", "number", "method" or "class", as the source suggests, or an empty string.

    True, False and None count as numbers, and functions as methods.
    """
    if isinstance(argument, ast.Constant):
        return "string" if isinstance(argument.value, str) else "number"
    name = dotted(argument) or ""
    own = [method.name for each in scene.classes for method in methods(each)]
    if name.startswith("self.") and name[len("self.") :] in own:
        return "method"
    if name and scene.functions(name):
        return "method"
    return "class" if name[:1].isupper() else ""


def why_type(scene: CrashScene) -> Cause | None:
    """Return the cause of a TypeError, such as wrong arguments or an object that is not callable, or None."""
    text = scene.crash.message
    found = callback_called(scene) or swapped(scene) or why_init_call(scene) or why_maker_call(scene)
    if found is not None:
        return found
    missing, many, keyword = MISSING.search(text), TOO_MANY.search(text), KEYWORD.search(text)
    if missing is not None:
        return _init_of(scene, missing) or _too_few(scene, missing["function"], missing["names"])
    if many is not None:
        if many["function"] == "__init__" and (many["of"] in ros_names.FIELDS or INNER.search(many["of"] or "")):
            return Cause("message-arguments", "Create the message without arguments, then set its fields one by one.")
        return _too_many(scene, many)
    if keyword is not None:
        more = f" Pass {TAKES[keyword['function']]}." if keyword["function"] in TAKES else ""
        return Cause("unexpected-keyword", f"{keyword['function']} has no parameter {keyword['name']}.{more}")
    if (expected := EXPECTED.search(text)) is not None:
        return published_other(scene, expected["wanted"], expected["got"])
    if text.startswith("Third element") and scene.calls_on_line("declare_parameter"):
        text = "The third argument of declare_parameter is a ParameterDescriptor. The description is one of its fields."
        return Cause("parameter-descriptor", text)
    if (called := NOT_CALLABLE.search(text)) is not None:
        return _not_callable(scene, called["type"])
    if "'Parameter'" in text:
        text = "get_parameter returns the parameter itself. The value of the parameter is in .value."
        return Cause("parameter-itself", text)
    return why_operands(scene) or _by_message(scene, text)


def _by_message(scene: CrashScene, text: str) -> Cause | None:
    if "isinstance() arg 2 must be a type" in text:
        return message_for_class(scene)
    if "'property' object is not iterable" in text:
        spun = next(iter(scene.calls_on_line("spin")), None)
        name = ast.unparse(spun.args[0]) if spun is not None and spun.args else ""
        set_to = scene.module.names.get(name) if scene.module is not None else None
        spun_with = f"rclpy.spin was called with {shorten(name)}, which is a class."
        text = f"{spun_with if name else 'A class is used as a node.'} {CREATE_OBJECT}"
        fix = at(scene.at(set_to), ast.unparse(set_to), f"{ast.unparse(set_to)}()") if set_to is not None else ()
        return Cause("class-for-object", text, scene.at(set_to)).fixed_by(fix)
    if LOGGED in text:
        return Cause("string-and-number", "A log method takes a string. Use an f-string to put a number into a string.")
    if "'NoneType' object does not support the context manager" in text:
        return _with_init(scene) or _after_shutdown(scene) or _never_init(scene)
    if "rclpy_resolve_name(): incompatible" in text:
        text = "The name of a topic or service must be a string in quotation marks, or a variable with a string."
        return Cause("crash", text)
    if "Expected QoSProfile or int" in text:
        quotes = " without quotation marks" if "'str'" in text else ""
        return Cause("queue-size", f"The last argument is the queue size, a whole number{quotes}.")
    return None


def _with_init(scene: CrashScene) -> Cause | None:
    """Return the cause if a with statement on the line calls rclpy.init, else None."""
    entered = [item.context_expr for node in scene.nodes if isinstance(node, ast.With) for item in node.items]
    for call in scene.calls_on_line("init"):
        if call in entered and dotted(call.func) == "rclpy.init":
            text = "Only newer distributions allow rclpy.init in a with statement. In Jazzy, rclpy.init returns None."
            return Cause("crash", text, scene.at(call))
    return None


def _never_init(scene: CrashScene) -> Cause | None:
    if scene.evidence.code.calls("init"):
        return None
    return named_only(scene.evidence, "rclpy.init") or Cause("no-init", "rclpy.init is never called.")


def _after_shutdown(scene: CrashScene) -> Cause | None:
    """Return the cause if an earlier line of the same function, or of an __init__, calls shutdown, else None."""
    calls = (node for node in scene.nodes if isinstance(node, ast.Call) and node.lineno < scene.line)
    ended = [node for node in calls if (dotted(node.func) or "").rpartition(".")[2] in ("shutdown", "try_shutdown")]
    around = scene.function_around(ended[-1]) if ended else None
    if around is None or (around is not scene.function and around.name != "__init__"):
        return None
    text = "This call to shutdown ends ROS 2 in the program. No line after this call can spin or publish."
    return Cause("crash", text, scene.at(ended[-1]))


def _too_few(scene: CrashScene, function: str, names: str) -> Cause:
    own = too_few(scene, function, names)
    if own is not None:
        return own
    if function in TAKES:
        return Cause("argument-missing", f"{function} takes {TAKES[function]}.")
    return Cause("argument-missing", f"{function} needs {_more(names)}: {shorten(names)}.")


def _more(names: str) -> str:
    return "more arguments" if " and " in names else "another argument"


def _init_of(scene: CrashScene, missing: re.Match[str]) -> Cause | None:
    """Return the cause if arguments are missing for __init__ of a class from another file, except Node, else None."""
    of = missing["of"]
    if missing["function"] != "__init__" or of in (None, "Node") or scene.class_named(of) is not None:
        return None
    text = f"{of} needs {_more(missing['names'])}: {shorten(missing['names'])}."
    if of == "ActionServer":
        text += " A node that sends goals needs an ActionClient."
    return Cause("argument-missing", text)


def _too_many(scene: CrashScene, many: re.Match[str]) -> Cause | None:
    function = many["function"]
    own = too_many(scene, function)
    if own is not None:
        return own
    if function in ros_names.OTHERS["RcutilsLogger"]:
        text = f"{function} takes one string, not several as print does. Use an f-string to put everything into one."
        return Cause("log-arguments", text)
    if function in TAKES:
        return Cause("too-many-arguments", f"Pass only {TAKES[function]} to {function}.")
    calls = scene.calls_on_line(function)
    if len(calls) != 1 or any(isinstance(each, ast.Starred) for each in calls[0].args):
        return None
    passed = len(calls[0].args)
    # Python counts `self` as an argument of a method, too.
    most = int(many["most"]) - (int(many["given"]) - passed)
    takes = f"at most {count(most, 'positional argument')}" if most else "no positional arguments"
    text = f"{function} takes {takes}. This call passes {passed}.{MORE.get(function, '')}"
    return Cause("too-many-arguments", text)


STACK = " Put the arrays into a tuple: {}((a, b))."
MORE = {"get_logger": " get_logger() returns the logger, and the methods of the logger take the text."}
MORE |= {name: STACK.format(name) for name in ("column_stack", "hstack", "vstack", "concatenate")}


def _not_callable(scene: CrashScene, kind: str) -> Cause | None:
    for own in scene.classes:
        names = {each.name: each for each in methods(own)}
        for attribute, line in attributes_set(own):
            if attribute in names:
                text = f"self.{attribute} is assigned on line {line}, which hides the method of the same name."
                return Cause("name-used-twice", text, scene.at(line))
    made = scene.class_named(kind)
    if made is not None:
        inside = [each for each in scene.functions("__call__") if scene.function_around(each) is not None]
        text = f"An object of {kind} can be called only if the class has a method __call__."
        if inside:
            text = "__call__ is indented too far: it is inside another method, so the object cannot be called."
            return Cause("method-in-method", text, scene.at(inside[0]))
        return Cause("not-callable", text)
    if kind == "NoneType":
        for name, place in MAKERS.items():
            for call in (node for node in scene.nodes if isinstance(node, ast.Call)):
                called = (dotted(call.func) or "").rpartition(".")[2] == name and len(call.args) > place
                given = call.args[place] if called else None
                made_by = (dotted(given.func) or "") if isinstance(given, ast.Call) else ""
                if made_by.startswith("self.") or scene.functions(made_by):
                    text = (
                        f"{name} needs the method itself. With () after its name, "
                        f"{name} gets only the return value of the method."
                    )
                    return Cause("callback-called", text, scene.at(call))
    more = " Leave out the parentheses after it, or write * to multiply." if kind in ("int", "float") else ""
    more = " Call its method publish." if kind == "Publisher" else more
    return _module_called(scene, kind) or Cause(
        "not-callable", f"A value of type {shorten(kind)} is called like a function.{more}"
    )


def _module_called(scene: CrashScene, kind: str) -> Cause | None:
    """Return the cause if the line calls a module that the file imports by name, else None."""
    imported = [alias for node in scene.nodes if isinstance(node, ast.Import) for alias in node.names]
    names = {alias.asname or alias.name for alias in imported}
    called = [dotted(node.func) for node in scene.on_line if isinstance(node, ast.Call)]
    name = next((each for each in called if each in names), None) if kind == "module" else None
    return (
        Cause("not-callable", f"{name} is a module. Write the name of one of its functions after a dot.")
        if name
        else None
    )
