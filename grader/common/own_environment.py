"""Refuse to run in a .venv that was copied together with the folder of the course."""

from __future__ import annotations

import json
import shlex
import sys
from pathlib import Path

from grader.errors import MachineError


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
