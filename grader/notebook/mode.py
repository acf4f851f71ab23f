"""Find out whether nbgrader is executing the notebook, and whether the kernel runs inside a sandbox cell."""

from __future__ import annotations

import os

CONFINED = "GRADER_CONFINED"
"""The environment variable that is set in a kernel inside a sandbox cell. No further sandbox cell can be started
there."""


def grading() -> bool:
    """Return whether nbgrader is executing the notebook, either to autograde or to validate it."""
    return bool(os.environ.get("NBGRADER_EXECUTION"))


def confined() -> bool:
    """Return whether this kernel runs inside a sandbox cell."""
    return bool(os.environ.get(CONFINED))
