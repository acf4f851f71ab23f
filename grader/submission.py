"""Submission: the folder a student hands in, its one package found and read."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Mapping


@dataclass(frozen=True)
class Submission:
    """`package_dir` is the folder with package.xml or setup.py; `files` its files (POSIX path relative to it -> bytes).

    build/, install/, log/, hidden folders and what is not a regular file inside the folder are left out;
    `rejected` names those that are a fault of the submission (a symlink that leaves it, ...), with the reason.
    """

    name: str
    """As the user named it."""
    package_dir: Path
    files: Mapping[str, bytes]
    rejected: tuple[str, ...]
    digest: str
    """sha256 over the sorted paths and contents of `files`."""
