"""Explain a NameError for a name that the file binds, but elsewhere: later, in another function, or in a block."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.bindings import Binding, bindings, is_global
from grader.checks.causes.crash_scene import Function
from grader.common.words import shorten

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.checks.causes.crash_scene import CrashScene


def bound_elsewhere(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause if the place that binds the name explains why the name has no value on this line, else None."""
    found = [each for each in bindings(scene, name) if each.line != scene.line]
    plain = [each for each in found if each.of_class is None and not each.in_brackets]
    of_module = [each for each in plain if each.function is None or each.by_global]
    return (
        deleted(scene, name)
        or _of_main_block(scene, of_module)
        or _of_module(scene, of_module)
        or next((_of_function(scene, each) for each in plain if each not in of_module and _is_other(scene, each)), None)
        or _of_class(scene, [each for each in found if each.of_class is not None])
        or _in_brackets(found)
        or _without_value(scene, name, of_module)
    )


def deleted(scene: CrashScene, name: str) -> Cause | None:
    """Return the cause if del, or the end of an except block, deletes the name before this line, else None."""
    for node in scene.nodes:
        if not isinstance(node, ast.Name) or node.id != name or not isinstance(node.ctx, ast.Del):
            continue
        if node.lineno < scene.line and scene.function_around(node) is scene.function:
            return Cause("name-undefined", f"Line {node.lineno} deletes {name}, so {name} has no value here.")
    for each in bindings(scene, name):
        ends = each.node.end_lineno if isinstance(each.node, ast.ExceptHandler) else None
        if ends is not None and ends < scene.line and each.function in (None, scene.function):
            text = (
                f"Python deletes {name} at the end of the except block that begins on line {each.line}. Inside this "
                "block, store the value under another name."
            )
            return Cause("name-undefined", text)
    return None


def _of_main_block(scene: CrashScene, of_module: list[Binding]) -> Cause | None:
    """Return the cause if only lines below `if __name__ == "__main__":` bind the name, else None."""
    blocks = [node for node in scene.nodes if isinstance(node, ast.If) and "__name__" in ast.unparse(node.test)]
    spans = [(node.lineno, node.end_lineno or 0) for node in blocks]
    if scene.function is None or not of_module:
        return None
    if not all(any(first < each.line <= last for first, last in spans) for each in of_module):
        return None
    text = (
        f'Line {of_module[0].line} gives {of_module[0].name} a value, but it is below if __name__ == "__main__". '
        "ros2 run does not run such lines: it calls the function of the entry point. Move the line out of this block."
    )
    return Cause("name-undefined", text, scene.at(of_module[0].node))


def _of_module(scene: CrashScene, of_module: list[Binding]) -> Cause | None:
    """Return the cause if a line of the module that binds the name has not run yet, else None."""
    earlier = [each for each in of_module if each.function is None and each.line < scene.line]
    for each in () if earlier else of_module:
        if each.function is None and each.line > scene.line:
            gets = "is defined" if each.is_definition else "gets its value"
            return Cause("name-too-early", f"{each.name} {gets} on line {each.line}, after this line.")
        if each.function is not None and each.function is not scene.function:
            text = (
                f"{each.name} gets its value on line {each.line}, in {each.function.name}. That line has not run yet."
            )
            return Cause("name-too-early", text)
    return Cause("name-undefined", without_value(earlier[0])) if earlier else None


def without_value(binding: Binding) -> str:
    """Return a sentence about a place above that binds a name, although the name has no value."""
    name, line = binding.name, binding.line
    if binding.is_import:
        return f"Line {line} imports {name}, but this import has not run, or has failed."
    text = f"Line {line} gives {name} a value, but {name} has none here. Perhaps that line has not run."
    return without_items(binding) or text


def without_items(binding: Binding) -> str:
    """Return a sentence if the place is a for statement, whose loop may have no item, else an empty string."""
    if not binding.of_loop:
        return ""
    return f"{binding.name} gets a value only if the loop on line {binding.line} has at least one item."


def _is_other(scene: CrashScene, binding: Binding) -> bool:
    return binding.function is not None and binding.function is not scene.function


def _of_function(scene: CrashScene, binding: Binding) -> Cause:
    """Return the cause for a name that only another function binds."""
    name, function = binding.name, binding.function
    assert function is not None
    if binding.is_definition:
        text = (
            f"{name} is defined inside {function.name} (line {binding.line}), so {name} does not exist in other "
            "functions."
        )
        return Cause("local-name", text)
    text = (
        f"{name} is a local variable of {function.name} (line {binding.line}). A local variable does not exist in "
        "other functions."
    )
    own = scene.own_class.name if scene.own_class is not None and scene.function is not None else None
    assigned = [node.value for node in scene.nodes if isinstance(node, ast.Assign) and binding.node in node.targets]
    if any(ast.unparse(value).startswith(f"{own}(") for value in assigned):
        text += f" Inside the methods of {own}, the object is self."
    return Cause("local-name", text)


def _of_class(scene: CrashScene, of_class: list[Binding]) -> Cause | None:
    """Return the cause if the body of a class binds the name, and this line is in another place, else None."""
    for each in of_class:
        assert each.of_class is not None
        owner = shorten(each.of_class.name)
        if each.of_class is scene.own_class:
            if scene.function is None and each.line > scene.line:
                return Cause("name-too-early", f"{each.name} gets its value on line {each.line}, after this line.")
            continue
        if each.is_definition:
            text = (
                f"{each.name} is a method of {owner} (line {each.line}). Call it on an object of {owner}, with a dot."
            )
            if isinstance(each.node, ast.ClassDef):
                text = f"{each.name} is inside the class {owner} (line {each.line}). Write {owner}.{each.name}."
        else:
            text = f"{each.name} belongs to the class {owner} (line {each.line}). Write {owner}.{each.name}."
        return Cause("name-undefined", text)
    return None


def _in_brackets(found: list[Binding]) -> Cause | None:
    """Return the cause if the name is the variable of a comprehension, else None."""
    for each in found:
        if each.in_brackets:
            text = f"{each.name} exists only inside the brackets of the comprehension on line {each.line}."
            return Cause("local-name", text)
    return None


def _without_value(scene: CrashScene, name: str, of_module: list[Binding]) -> Cause | None:
    """Return the cause if the line needs the old value of a name that only this function or line binds, else None."""
    if scene.function is not None and is_global(scene.function, name) and all(each.by_global for each in of_module):
        text = (
            f"The line global {name} gives {name} no value. Give {name} a first value at the top of the file, outside "
            "all functions."
        )
        return Cause("name-undefined", text)
    if any(each.line == scene.line and not each.in_brackets for each in bindings(scene, name)):
        text = f"This line needs a value of {name} to compute a new one. Give {name} a first value on an earlier line."
        return Cause("name-too-early", text)
    return None


def stores(scene: CrashScene, name: str) -> Iterator[tuple[int, Function | None]]:
    """Yield each line that binds the name, with the innermost function that contains the line, or None.

    The bodies of classes and the variables of comprehensions do not count.
    """
    for each in bindings(scene, name):
        if each.of_class is None and not each.in_brackets:
            yield each.line, each.function


def as_parameter(scene: CrashScene, name: str) -> str:
    """Return a sentence if the name is a parameter of another function, else an empty string."""
    for node in scene.nodes:
        if not isinstance(node, Function | ast.Lambda) or node is scene.function:
            continue
        named = node.args
        arguments = [*named.posonlyargs, *named.args, *named.kwonlyargs, named.vararg, named.kwarg]
        if name in [each.arg for each in arguments if each is not None]:
            of = "a lambda" if isinstance(node, ast.Lambda) else node.name
            return f"{name} is a parameter of {of} (line {node.lineno}), and exists only in that function."
    return ""
