"""Check the course's folder: the programs of the set-up must support its path, and must be able to run there.

Like machine.py, this module runs under any Python from 3.6 on, before anything is installed, so it uses only the syntax
of Python 3.6.
"""

import os
from pathlib import Path

from grader.common.noexec import noexec_folder, noexec_sentence

_REFUSED = frozenset(':;"\\#?[]|$`')
"""Characters that make the set-up or colcon fail, because they have a special meaning in a search path, a CMake list, a
URL, a pattern, a ninja file, or a shell string."""


def place_problem(folder: Path) -> str:
    """Return a text that says why the course cannot be set up in this folder and what to do, or an empty string."""
    try:
        path = os.fsencode(folder).decode("utf-8")
    except UnicodeDecodeError:
        path = str(folder)
    refused = sorted({sign for sign in path if sign in _REFUSED or not sign.isprintable()})
    if not refused:
        mounted = noexec_folder(folder / ".venv")
        instead = "copy the course's folder to another file system, and type the same command there"
        return noexec_sentence(mounted, instead) if mounted else ""
    return (
        f"The path of the course's folder, {path!a}, contains {' '.join(map(ascii, refused))}. CMake, colcon or Python "
        "cannot handle this. Rename or move the folder, so that its path consists of letters, digits, spaces, - and _, "
        "and type the same command there."
    )
