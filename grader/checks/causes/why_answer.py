"""Explain why an answer in answers.toml is wrong, or why the file cannot be read."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

KEEP_LOOKING = "Run the `ros2` command again and compare letter by letter."
YAML = re.compile(r"^\s*[\w-]+\s*:")
"""Matches a line in which a colon is between the name and the answer, as in YAML."""


def why_unreadable(source: bytes, line: int | None) -> str:
    """Return the reason why Python cannot read this line of answers.toml (from 1)."""
    lines = source.decode("utf-8", "replace").splitlines()
    if line is not None and 0 < line <= len(lines) and YAML.match(lines[line - 1]):
        return "This line has a colon after the name. In TOML, = is between the name and the answer."
    return 'Write a string in "quotation marks", a list in [brackets], and a number without either.'


def why_list(given: Sequence[str], truth: Collection[str]) -> Cause | None:
    """Return the cause if a string contains several items, or the slashes of full names are missing, else None."""
    if any("," in each for each in given):
        text = "A string contains a comma, so it counts as one item. Put each item in its own quotation marks."
        return Cause("wrong-list", text)
    if given and {f"/{each}" for each in given} == set(truth):
        return Cause("no-slash", "A full name starts with a slash.")
    return None


def why_name(answer: str, find: str, truth: Collection[str], others: Collection[str]) -> Cause:
    """Return the reason why the name of a topic, type or node is wrong. `truth` contains the right names."""
    if find in ("topic", "node") and f"/{answer}" in truth:
        return Cause("no-slash", f"The full name of a {find} starts with a slash.")
    if find == "type" and any(each.replace("/msg/", "/") == answer for each in truth):
        return Cause("type-without-msg", "In ROS 2 a type has three parts: the package, the word msg, and the name.")
    if find == "type" and any(each.endswith(f"/{answer}") for each in truth):
        text = "The full name of a type starts with its package, as in std_msgs/msg/String."
        return Cause("type-without-package", text)
    if any(each.lower() == answer.lower() for each in truth):
        return Cause("capitals", "Upper and lower case matter.")
    if answer in others:
        return Cause("answer-another", f"This {find} exists, but it is not the one that the question asks for.")
    return Cause("wrong-answer", KEEP_LOOKING)
