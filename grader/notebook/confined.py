"""A kernel in a cell (grader.sandbox), for `nbgrader autograde`: `python -m grader.notebook.confined FOLDER -f FILE`.

FOLDER is a copy of the submission that can only be read. The kernel works on a copy of its own, on the cell's disk:
what it writes goes with it.
"""

from __future__ import annotations

import os
import shutil
import sys

from grader.sandbox.bubblewrap import WORKSPACE


def main() -> None:
    """Become the kernel."""
    # Before the submission's folder is the current one: its modules must not stand in for Python's.
    from ipykernel import kernelapp

    folder = WORKSPACE / "submission"
    shutil.copytree(sys.argv[1], folder, symlinks=True)
    os.chdir(folder)
    kernelapp.launch_new_instance(argv=sys.argv[2:])  # type: ignore[no-untyped-call, unused-ignore]


if __name__ == "__main__":
    main()
