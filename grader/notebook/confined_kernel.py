"""A Jupyter kernel in a sandbox cell (grader.sandbox), for `nbgrader autograde`.

    python -m grader.notebook.confined_kernel FOLDER WORKSPACE -f CONNECTION_FILE     what bridge.py starts

FOLDER is a read-only copy of the submission. The kernel works on its own copy in WORKSPACE, on the cell's disk, which
is deleted with the cell.
"""

from __future__ import annotations

import os
import shutil
import sys
from pathlib import Path


def main() -> None:
    """Run the kernel in this process."""
    # Import this before changing to the submission's folder, whose modules must not shadow Python's.
    from ipykernel import kernelapp

    folder = Path(sys.argv[2], "submission")
    shutil.copytree(sys.argv[1], folder, symlinks=True)
    os.chdir(folder)
    kernelapp.launch_new_instance(argv=sys.argv[3:])  # type: ignore[no-untyped-call, unused-ignore]


if __name__ == "__main__":
    main()
