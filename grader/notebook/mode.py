"""Whether a notebook is executed by nbgrader or inside a cell, which changes the behaviour of the magics."""

from __future__ import annotations

import os

CONFINED = "GRADER_CONFINED"
"""Set in a kernel that runs inside a cell (grader.sandbox), where another cell cannot be started."""


def grading() -> bool:
    """Return whether nbgrader executes the notebook, to autograde or to validate it."""
    return bool(os.environ.get("NBGRADER_EXECUTION"))


def confined() -> bool:
    """Return whether this kernel runs inside a cell."""
    return bool(os.environ.get(CONFINED))
