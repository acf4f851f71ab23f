"""Explain why setuptools cannot read an entry point in console_scripts."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.edit import at
from grader.checks.outcome import Finding, failed
from grader.common.words import shorten
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.submission.setup_py import EntryPoint

BRACES = re.compile(rb"[\"']console_scripts[\"']\s*:\s*\{")
"""Matches console_scripts with a dictionary."""
JOINED = re.compile(r"=[^=]*:[^=]*=")
"""Matches an equals sign, a colon and another equals sign, in this order, as in a string with several entry points."""


def bad_entry_point(point: EntryPoint) -> Finding:
    """Return a failed finding about an entry point that setuptools cannot read."""
    observed = f'setuptools cannot read the entry point "{shorten(point.text)}".'
    expected = "An entry point has the form NAME = PACKAGE.MODULE:FUNCTION."
    where = Where("setup.py", point.line)
    why = Cause("entry-point-format", "Check the entry point character by character: = and : must each appear once.")
    module = point.text.partition("=")[2].partition(":")[0]
    if is_joined(point):
        text = "This string contains more than one entry point. Write one string for each, with a comma after it."
        why = Cause("entry-point-comma", text)
    elif "/" in point.text:
        why = Cause(
            "entry-point-slash",
            "The entry point contains a file path. A module name has a dot between folder and file.",
        )
        why = why.fixed_by(at(where, "/", "."))
    elif "(" in point.text:
        why = Cause(
            "entry-point-format",
            "An entry point names a function but does not call the function: leave out the parentheses.",
        )
        why = why.fixed_by(at(where, point.text, point.text.partition("(")[0]))
    elif ":" not in point.text:
        text = "The entry point does not name a function. After the module, write a colon and the function name."
        why = Cause("entry-point-no-function", text)
    elif "-" in module:
        text = "A module name cannot contain a hyphen. Use underscores in the names of Python files and folders."
        why = Cause("entry-point-format", text).fixed_by(at(where, module, module.replace("-", "_")))
    return failed(observed, expected, why.at(where))


def scripts_in_braces(source: bytes) -> Finding | None:
    """Return a failed finding if console_scripts in this setup.py is a dictionary, else None."""
    found = BRACES.search(source)
    if found is None:
        return None
    expected = "console_scripts is a list of strings of the form NAME = PACKAGE.MODULE:FUNCTION."
    text = "Here, console_scripts is a dictionary. Write square brackets, and one string for each entry point."
    where = Where("setup.py", source[: found.start()].count(b"\n") + 1)
    return failed("setuptools cannot read console_scripts.", expected, Cause("entry-point-format", text, where))


def is_joined(point: EntryPoint) -> bool:
    """Return whether the string contains more than one entry point."""
    return JOINED.search(point.text) is not None
