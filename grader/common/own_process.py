"""Prepare a process of the grader so that it works with any user settings.

Each command of the grader calls `prepare` at its start. Child processes inherit the changes, except for the warnings
filter.
"""

from __future__ import annotations

import json
import os
import shlex
import sys
import warnings
from pathlib import Path

from grader.common import terminal_text, xdg
from grader.errors import MachineError

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


def require_own_environment() -> None:
    """Raise MachineError if .venv was copied together with the folder of the course, and not set up again.

    The packages in .venv contain the path of the folder from which they were copied, so each command would run the code
    of that folder, and show or change its files.
    """
    here = Path(sys.prefix).parent
    try:
        made = json.loads(Path(sys.prefix, "course-setup.json").read_text("utf-8"))["root"]
        copied = not Path(made).samefile(here)
    except (OSError, ValueError, KeyError, TypeError):
        return  # `make demo` has not finished, or the other folder no longer exists
    if copied:
        message = (
            f"{sys.prefix} was copied from {made}, and its commands use the files there. Set up the course again: "
            f"cd {shlex.quote(str(here))} && make demo"
        )
        raise MachineError(message)
