"""The course in Jupyter. `%load_ext grader.notebook` adds the magics, `check` and `simulator` to a notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from IPython.core.interactiveshell import InteractiveShell


def load_ipython_extension(shell: InteractiveShell) -> None:
    """Load the extension. `%load_ext grader.notebook` calls this function."""
    from grader.notebook.extension import load

    load(shell)
