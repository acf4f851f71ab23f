"""How a notebook is being run: by somebody who looks at it, or by nbgrader, which wants it quick and quiet."""

from __future__ import annotations

import os

CONFINED = "GRADER_CONFINED"
"""Set in a kernel that runs in a cell (grader.sandbox) already: nothing below it can be confined once more."""


def grading() -> bool:
    """Whether nbgrader runs the notebook, to autograde or to validate it."""
    return bool(os.environ.get("NBGRADER_EXECUTION"))


def confined() -> bool:
    """Whether this kernel is in a cell."""
    return bool(os.environ.get(CONFINED))
