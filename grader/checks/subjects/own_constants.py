"""Check that a module of the package has the student's own numbers in its constants."""

from __future__ import annotations

import ast
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.syntax import unreadable_finding
from grader.checks.kind import Kind, string, table
from grader.checks.outcome import Finding, failed, passed
from grader.checks.own_values import numbers_spec
from grader.common.words import shorten
from grader.submission.code import module_file, read_module
from grader.submission.constants import dotted, number
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module

NOT_WRITTEN = "Write the number into the node. `colcon test` runs your tests on this node."

NOT_USED = "Use the constant where the node needs this number. Otherwise, the constant has no effect."


@dataclass(frozen=True, kw_only=True)
class OwnConstants:
    """A module, and the names and required values of its constants."""

    module: str = string("the name of a module", about="The module, such as `my_robot_controller.wall_guard`.")
    constants: tuple[tuple[str, float], ...] = table(
        about="The names of the constants with their values, which can be the student's own numbers."
    )


def own_constants(evidence: Evidence, params: OwnConstants) -> Finding:
    """Each constant has the student's number, and the node uses the constant.

    A constant whose value is known only at run time, for example because it is read from a file, is not judged. If the
    module has no constant with the name, the number must occur in the source.
    """
    files = evidence.submission.files
    file = module_file(params.module, files)
    wanted = ", ".join(f"{name} = {value}" for name, value in params.constants)
    expected = f"{params.module} has your numbers from {numbers_spec(evidence).file}: {wanted}."
    if file is None:
        observed = f"The package has no module {shorten(params.module, 60)}."
        return failed(observed, expected, Cause("own-number-missing"))
    module = read_module(file, files[file])
    if module.unreadable is not None:
        return unreadable_finding(file, module.unreadable, files[file])
    # The node can import its numbers from another file of the package.
    imported = evidence.code.modules if evidence.node_file == file else ()
    modules = (module, *(each for each in imported if each.file != file))
    for name, value in params.constants:
        given = _last_assignment(modules, name)
        if given is None:
            if not _has_number(modules, value):
                observed = f"{shorten(file, 60)} has no constant {name}, and does not contain the number {value}."
                return failed(observed, expected, Cause("own-number-missing", NOT_WRITTEN, Where(file)))
            continue
        place, expression = given
        is_now = number(expression, place.names)
        where = Where(place.file, expression.lineno)
        if is_now is not None and not math.isclose(is_now, value):
            return failed(f"{name} is {is_now}.", expected, Cause("own-number-missing", NOT_WRITTEN, where))
        if is_now is not None and not any(_uses(each, name) for each in modules):
            observed = f"{shorten(file, 60)} does not use {name}."
            return failed(observed, expected, Cause("own-number-missing", NOT_USED, where))
    return passed(expected)


def _last_assignment(modules: tuple[Module, ...], name: str) -> tuple[Module, ast.expr] | None:
    """Return the first module that assigns to this name, and the last value that it assigns, or None."""
    for module in modules:
        given = [value for target, value in _assignments(module) if (dotted(target) or "").split(".")[-1] == name]
        if given:
            return module, max(given, key=lambda value: value.lineno)
    return None


def _assignments(module: Module) -> Iterator[tuple[ast.expr, ast.expr]]:
    """Yield the target and the value of each assignment with =, including those of `a, b = 1, 2`."""
    for node in module.nodes:
        if isinstance(node, ast.AnnAssign) and node.value is not None:
            yield node.target, node.value
        elif isinstance(node, ast.Assign):
            for target in node.targets:
                targets = target.elts if isinstance(target, ast.Tuple) else [target]
                values = node.value.elts if isinstance(node.value, ast.Tuple) else [node.value] * len(targets)
                yield from zip(targets, values, strict=False)


def _uses(module: Module, name: str) -> bool:
    """Return whether the module reads a variable or an attribute with this name, or contains the name as a string."""
    for node in module.nodes:
        match node:
            case (
                ast.Name(id=read, ctx=ast.Load()) | ast.Attribute(attr=read, ctx=ast.Load()) | ast.Constant(value=read)
            ):
                if read == name:
                    return True
    return False


def _has_number(modules: tuple[Module, ...], value: float) -> bool:
    constants = (node.value for module in modules for node in module.nodes if isinstance(node, ast.Constant))
    return any(isinstance(each, int | float) and math.isclose(each, value) for each in constants)


CONSTANTS = Kind(
    "own_constants",
    "source",
    "The module has your own numbers",
    OwnConstants,
    own_constants,
    about=(
        "The constants of a module have the given values, which can be the student's own numbers, and some code uses "
        "the constants. The grader does not run the file, so it accepts a value that it cannot compute from the "
        "source. It also accepts code that uses the number itself instead of the constant."
    ),
)
