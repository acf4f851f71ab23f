"""File systems that are mounted with the option noexec: the kernel runs no program and loads no library from them.

Like machine.py, this module runs under any Python from 3.6 on, before anything is installed, so it uses only the syntax
of Python 3.6.
"""

import os
import shlex
from pathlib import Path
from typing import Optional


def noexec_folder(path: Path) -> Optional[Path]:  # noqa: UP045 - valid in Python 3.6
    """Return the topmost folder of the noexec mount that contains `path`, or None if programs in `path` can run.

    `path` does not need to exist.
    """
    there = [folder for folder in (path, *path.parents) if os.path.exists(str(folder))]  # noqa: PTH110
    mounted = None
    for folder in there:
        if not os.statvfs(str(folder)).f_flag & os.ST_NOEXEC:
            break
        mounted = folder
    return mounted


def noexec_sentence(folder: Path, instead: str) -> str:
    """Return the sentence for a folder that `noexec_folder` has found.

    `instead` is a phrase that says what to do instead.
    """
    remount = f"sudo mount -o remount,exec {shlex.quote(str(folder))}"
    return (
        f"{folder} is mounted with the option noexec, so the system runs no programs from there: "
        f"{instead}, or allow programs with: {remount}"
    )
