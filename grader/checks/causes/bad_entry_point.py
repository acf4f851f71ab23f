"""A string in console_scripts that setuptools cannot read."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.checks.outcome import Finding, failed
from grader.common.words import shorten
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.submission.setup_py import EntryPoint


def bad_entry_point(point: EntryPoint) -> Finding:
    """A failed finding about a text in console_scripts that is of no form that setuptools knows."""
    seen = f'setuptools cannot read the entry point "{shorten(point.text)}".'
    expected = "An entry point reads NAME = PACKAGE.MODULE:FUNCTION."
    diagnosis, cause = "entry-point-format", "Compare it sign by sign: = and : each stand once."
    if point.text.count("=") > 1:
        diagnosis, cause = "entry-point-comma", "A comma is missing between two texts, so Python joins them to one."
    elif "/" in point.text:
        diagnosis, cause = "entry-point-slash", "This is a file's path; a module has points between folder and file."
    elif ":" not in point.text:
        cause = "It names no function: after the module come a colon and the function's name."
        diagnosis = "entry-point-no-function"
    return failed(diagnosis, seen, expected, cause, where=Where("setup.py", point.line))
