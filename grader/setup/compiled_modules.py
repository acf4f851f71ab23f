"""Compiled modules (.pyc) that are incomplete because the disk was full when Python stored them.

Python does not compile such a module again. Instead, each later import of the module fails with an EOFError.
"""

import marshal
from pathlib import Path

HEADER = 16
"""The size of the header of a compiled module (bytes): PEP 552."""


def remove_incomplete(folder: Path) -> None:
    """Remove the incomplete modules in this folder and its subfolders.

    Python compiles a removed module again when the module is imported.
    """
    for path in folder.rglob("__pycache__/*.pyc"):
        if not is_complete(path):
            path.unlink()


def is_complete(path: Path) -> bool:
    """Return whether Python can load this compiled module.

    The result can also be False for a module that another version of Python compiled.
    """
    try:
        marshal.loads(path.read_bytes()[HEADER:])
    except (EOFError, ValueError, TypeError):
        return False
    return True
