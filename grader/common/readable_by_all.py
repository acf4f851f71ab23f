"""Make files readable by every user. If root runs the grader, student code runs in a cell as another user.

Like machine.py, this module runs under any Python from 3.6 on, before anything is installed, so it uses only the syntax
of Python 3.6.
"""

from pathlib import Path


def make_readable(folder: Path) -> None:
    """Let every user read the files (a+rX), whatever the umask was when they were created."""
    for path in [folder, *folder.rglob("*")]:
        if not path.is_symlink():
            mode = path.stat().st_mode
            wanted = mode | (0o555 if path.is_dir() or mode & 0o111 else 0o444)
            if mode != wanted:
                path.chmod(wanted)
