"""The course in Jupyter: `%load_ext grader.notebook` brings the magics, `check` and `simulator` into a notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from IPython.core.interactiveshell import InteractiveShell


def load_ipython_extension(shell: InteractiveShell) -> None:
    """What `%load_ext grader.notebook` calls."""
    from grader.notebook.extension import load

    load(shell)
