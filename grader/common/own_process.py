"""Prepare a process of the grader so that it works with any user settings.

Each command of the grader calls `prepare` at its start. Child processes inherit the changes, except for the warnings
filter.
"""

from __future__ import annotations

import os
import sys
import warnings

from grader.common import terminal_text, xdg

LEAST_COLUMNS = 20
"""The smallest width for which rich can lay out a table of the grader. A narrower terminal breaks the lines."""


def prepare() -> None:
    """Make this process independent of unusual settings."""
    # With PYTHONWARNINGS=error, each warning of an installed package would be an exception.
    warnings.simplefilter("ignore")
    # The grader must be able to read what it writes, whatever the user's umask is.
    os.umask(os.umask(0o077) & 0o077)
    if not os.environ.get("HOME", "").startswith("/"):
        os.environ["HOME"] = str(xdg.home())
    # rich prints nothing if COLUMNS is 0, and fails on a terminal with a few columns.
    if os.environ.get("COLUMNS", "").isdecimal() and not int(os.environ["COLUMNS"]):
        del os.environ["COLUMNS"]
    width = terminal_text.columns(sys.stdout)
    if width is not None and width < LEAST_COLUMNS:
        os.environ["COLUMNS"] = str(LEAST_COLUMNS)
