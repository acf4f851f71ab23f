"""Mistakes in names, attributes and imports of a node."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.tests.operators.operator import (
    Change,
    Operator,
    Package,
    edited,
    line_at,
    misspelt,
    remove_line,
    replace,
)

if TYPE_CHECKING:
    from collections.abc import Callable
    from random import Random

    from grader.checks.diagnosis import Diagnosis
    from grader.tests.operators.operator import Replacement

MISSPELT: tuple[Diagnosis, ...] = ("attribute-misspelt", "name-misspelt", "message-field", "import-name")
METHODS = r"create_publisher|create_timer|create_subscription|get_logger|publish|info"


def _source(name: str, pattern: str, by: Replacement, *says: Diagnosis, never: str = "") -> Operator:
    return Operator(name, replace(pattern, by), frozenset(says), never)


def _misspells(name: str, pattern: str, *says: Diagnosis) -> Operator:
    """Return an operator that misspells the group `word` of one match."""

    def make(package: Package, draw: Random) -> Change | None:
        def by(match: re.Match[str]) -> str:
            begin, end = match.start("word") - match.start(), match.end("word") - match.start()
            return match[0][:begin] + misspelt(match["word"], draw) + match[0][end:]

        return replace(pattern, by)(package, draw)

    return Operator(name, make, frozenset(says))


def _attribute_without_self(package: Package, draw: Random) -> Change | None:
    """Remove `self.` where an attribute is used, but not where it is set."""
    text = package.files[package.source]
    stored = set(re.findall(r"^\s+self\.(\w+)(?:: [^=]*)? = ", text, re.MULTILINE))
    uses = [m for m in re.finditer(r"self\.(\w+)(?! *(?:: [^=\n]*)?[-+]?=[^=])", text) if m[1] in stored]
    if not uses:
        return None
    use = draw.choice(uses)
    new = text[: use.start()] + use[1] + text[use.end() :]
    return edited(package, package.source, new, line_at(text, use.start()))


def _stored_without_self(package: Package, draw: Random) -> Change | None:
    """Remove `self.` where an attribute is set, if the attribute is set only once and is used elsewhere."""
    text = package.files[package.source]
    stores = [
        m
        for m in re.finditer(r"^(\s+)self\.(\w+)(?= = )", text, re.MULTILINE)
        if len(re.findall(rf"self\.{m[2]}\b(?! = )", text)) and len(re.findall(rf"self\.{m[2]} = ", text)) == 1
    ]
    if not stores:
        return None
    store = draw.choice(stores)
    new = text[: store.start()] + store[1] + store[2] + text[store.end() :]
    return edited(package, package.source, new, line_at(text, store.start(2)))


def _misspelt_attribute(package: Package, draw: Random) -> Change | None:
    """Misspell an attribute where it is used. A report may name this line, or the line that assigns the attribute."""
    text = package.files[package.source]
    stores = {m[1]: m for m in re.finditer(r"^\s+self\.(\w+) = ", text, re.MULTILINE)}
    uses = [m for m in re.finditer(r"self\.(\w+)(?! = )", text) if m[1] in stores and len(m[1]) > 3]
    if not uses:
        return None
    use = draw.choice(uses)
    lines = {line_at(text, use.start()), line_at(text, stores[use[1]].start(1))}
    new = text[: use.start(1)] + misspelt(use[1], draw) + text[use.end(1) :]
    return edited(package, package.source, new, *lines)


def _module_without_import(name: str) -> Callable[[Package, Random], Change | None]:
    return remove_line(rf"^import {name}$")


OPERATORS = (
    Operator("use-without-self", _attribute_without_self, frozenset({"missing-self"})),
    Operator("store-without-self", _stored_without_self, frozenset({"missing-self"})),
    Operator("attribute-misspelt", _misspelt_attribute, frozenset({"attribute-misspelt", "attribute-too-early"})),
    _source("maker-without-self", r"self\.(create_\w+|get_logger)\(", r"\1(", "missing-self"),
    _source(
        "callback-without-self",
        r"(create_timer\([^,\n]*, |create_subscription\([^,\n]*, [^,\n]*, )self\.",
        r"\1",
        "missing-self",
    ),
    _misspells("method-misspelt", rf"\.(?P<word>{METHODS})\(", "attribute-misspelt"),
    _misspells("variable-misspelt", r"^    +(?!self)(?P<word>[a-z]{3,})(?=\.\w)", "name-misspelt"),
    _misspells("function-of-rclpy-misspelt", r"rclpy\.(?P<word>init|spin)\(", "attribute-misspelt"),
    _misspells("class-misspelt-in-import", r"^from \S+ import (?P<word>Node|Twist|Pose)$", "import-name"),
    _misspells("class-misspelt-where-used", r"(?<=\()(?P<word>Node|Twist|Pose)\b", "name-misspelt"),
    _misspells("module-misspelt", r"^from (?P<word>geometry_msgs|turtlesim)\.msg", "module-misspelt"),
    _misspells("field-misspelt", r"\.(?P<word>linear|angular|theta)\b", "message-field"),
    _source("field-capital", r"\.(linear|angular)\.([xz])\b", lambda m: f".{m[1]}.{m[2].upper()}", "message-field"),
    _source("field-of-field-left-out", r"\.(linear|angular)\.[xz] = ", r".\1 = ", "field-type"),
    _source("pose-position", r"\bpose\.([xy])\b", r"pose.position.\1", "message-field"),
    _source("class-small", r"= (Twist)\(\)", r"= twist()", "name-misspelt", "missing-import"),
    _source("ros-1", r"^import rclpy$", "import rospy", "ros-1-module", "missing-import"),
    _source("turtlesim-msgs", r"from turtlesim\.msg", "from turtlesim_msgs.msg", "turtlesim-msgs"),
    _source("module-without-msg", r"from geometry_msgs\.msg", "from geometry_msgs", "import-wrong-place"),
    _source("node-from-rclpy", r"from rclpy\.node import Node", "from rclpy import Node", "import-wrong-place"),
    _source("twist-from-std-msgs", r"from geometry_msgs\.msg import", "from std_msgs.msg import", "import-wrong-place"),
    Operator("rclpy-not-imported", remove_line("^import rclpy$"), frozenset({"missing-import"})),
    Operator("math-not-imported", _module_without_import("math"), frozenset({"missing-import"})),
    Operator(
        "class-not-imported",
        remove_line(r"^from (rclpy\.node|\w+\.msg) import \w+$"),
        frozenset({"missing-import"}),
    ),
    _source("without-math", r"math\.(pi|hypot|atan2|sqrt|cos|sin)\b", r"\1", "module-prefix"),
    _source("class-without-its-module", r"\b(rclpy\.)(init|spin)\(", r"\2(", "module-prefix"),
    _source("topic-without-quotes", r"[\"']/turtle1/(cmd_vel|pose)[\"']", r"\1", "name-undefined"),
    _source("node-name-without-quotes", r"(super\(\).__init__\()[\"'](\w+)[\"']", r"\1\2", "name-undefined"),
    _source(
        "self-parameter-left-out",
        r"^(    def (?!__init__)\w+)\(self(, )?",
        r"\1(",
        "self-parameter",
        "callback-parameters",
    ),
    _source("self-parameter-of-init", r"^(    def __init__)\(self(, )?", r"\1(", "self-parameter"),
    _source(
        "parameter-too-many",
        r"^(    def (?!__)\w+)\(self\):",
        r"\1(self, msg):",
        "callback-parameters",
        "argument-missing",
    ),
    _source("message-left-out", r"^(    def \w+)\(self, (?:msg|pose)\):", r"\1(self):", "callback-parameters"),
)
