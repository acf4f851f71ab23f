"""How a notebook is being run: for a reader, or by nbgrader, which needs it to be fast and quiet."""

from __future__ import annotations

import os

CONFINED = "GRADER_CONFINED"
"""Set in a kernel that already runs in a cell (grader.sandbox). Another cell cannot be started inside it."""


def grading() -> bool:
    """Return whether nbgrader runs the notebook, to autograde or to validate it."""
    return bool(os.environ.get("NBGRADER_EXECUTION"))


def confined() -> bool:
    """Return whether this kernel is in a cell."""
    return bool(os.environ.get(CONFINED))
