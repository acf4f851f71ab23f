"""Syntax errors in the file of a node, and wrong indentation that Python accepts."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.tests.operators.operator import Change, Make, Operator, Package, edited, line_at, replace

if TYPE_CHECKING:
    from random import Random

    from grader.checks.diagnosis import Diagnosis
    from grader.tests.operators.operator import Replacement

BLOCK = r"^( *(?:def|class|if|try|except|finally|for|while|else)\b.*):(?= *(?:#.*)?$)"


def _source(name: str, pattern: str, by: Replacement, *says: Diagnosis, never: str = "") -> Operator:
    return Operator(name, replace(pattern, by), frozenset(says), never)


def _method_moved(by: int) -> Make:
    """Indent a method with its whole body by one level more, or, if `by` is negative, by one level less."""

    def make(package: Package, draw: Random) -> Change | None:
        text = package.files[package.source]
        found = list(
            re.finditer(r"^    def (?!__init__).*\n(?:(?:        .*)?\n)+?(?=\S|    def|\Z)", text, re.MULTILINE)
        )
        if not found:
            return None
        method = draw.choice(found)
        lines = method[0].split("\n")
        moved = [line[4:] if by < 0 else f"    {line}" for line in lines]
        new = text[: method.start()] + "\n".join(line.rstrip() for line in moved) + text[method.end() :]
        return edited(package, package.source, new, line_at(text, method.start()))

    return make


def _body_left_out(package: Package, draw: Random) -> Change | None:
    """Remove the body of a method.

    Return None if Python can read the rest, because this means that a part of the body is left.
    """
    change = replace(r"^(    def \w+\(.*\):)\n(?:        .*\n)+", r"\1" + "\n")(package, draw)
    try:
        compile(change.files[change.file] if change else "", "", "exec", ast.PyCF_ONLY_AST)
    except SyntaxError:
        return change
    return None


def _main_in_class(package: Package, _: Random) -> Change | None:
    text = package.files[package.source]
    found = re.search(r"^def main\(.*\n(?:(?:    .*)?\n)+", text, re.MULTILINE)
    if found is None or "\nclass " not in text:
        return None
    moved = "\n".join(f"    {line}".rstrip() for line in found[0].split("\n"))
    return edited(
        package, package.source, text[: found.start()] + moved + text[found.end() :], line_at(text, found.start())
    )


def _main_renamed(package: Package, draw: Random) -> Change | None:
    """Rename the function main. A report may name the line of setup.py that refers to the function main."""
    change = replace(r"^def main\(", "def run(")(package, draw)
    return change and Change(change.files, "setup.py")


SYNTAX: tuple[Diagnosis, ...] = ("syntax-error",)
OPERATORS = (
    _source("colon-left-out", BLOCK, r"\1", "colon-missing"),
    _source("colon-a-semicolon", BLOCK, r"\1;", "colon-missing", *SYNTAX),
    _source("bracket-left-out", r"\)$", "", "bracket-open"),
    _source("bracket-too-many", r"\)$", "))", "bracket-extra"),
    _source("quote-left-out", r"(?<=[\w.])([\"'])(?=[,)])", "", "quote-open"),
    _source("quote-typographic", r"\"(/?\w[\w/]*)\"", "\u201c\\1\u201d", "typographic-character"),
    _source("comma-left-out", r"(?<=\w), (?=[\"'])", " ", "comma-missing", *SYNTAX),
    _source("comma-for-dot", r"(rclpy|self|msg)\.(?=\w+)", r"\1,", "comma-for-dot"),
    _source("space-after-def-left-out", r"^( *)def (\w+\()", r"\1def\2", *SYNTAX),
    _source("two-equals", r"^( +self\.\w+) = ", r"\1 == ", "equals", "attribute-missing"),
    _source("ampersands", r"if (.*):$", r"if \1 && True:", *SYNTAX),
    _source("line-too-far-right", r"^        (\w+\.\w+.*)$", r"          \1", "indentation"),
    _source("line-too-far-left", r"^        (\w+\.\w+.*)$", r"      \1", "indentation"),
    _source("tab", r"^        (\w+\.\w+.*)$", "\t\\1", "tabs-and-spaces"),
    Operator("body-left-out", _body_left_out, frozenset({"indentation"})),
    _source("conflict", r"^( +self\.\w+ = .*)$", "<<<<<<< HEAD\n\\1\n=======\n\\1\n>>>>>>> main", "merge-conflict"),
    _source("print-of-python-2", r"^( +)self\.get_logger\(\)\.info\((.*)\)$", r"\1print \2", "python-2-print"),
    # If the method has a decorator, the decorator stays where it is, and Python cannot read the file.
    Operator("method-outside-class", _method_moved(-1), frozenset({"method-outside-class", "indentation"})),
    Operator("method-in-method", _method_moved(1), frozenset({"method-in-method"})),
    Operator("main-in-class", _main_in_class, frozenset({"main-in-class"})),
    Operator("main-renamed", _main_renamed, frozenset({"entry-point-function"})),
)
