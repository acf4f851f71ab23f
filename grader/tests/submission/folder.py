"""Packages as folders, for tests of the modules that read them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

PACKAGE: dict[str, str | bytes] = {
    "package.xml": "<package/>",
    "setup.py": "",
    "pkg/__init__.py": "",
    "pkg/node.py": "x = 1\n",
}

ODD_NAMES = ["with blank.py", "café.py", "cafe\u0301.py", "日本.txt", "Node.py", "node.py", "-rf", "*", "'\""]


def make(folder: Path, files: dict[str, str | bytes]) -> Path:
    for path, data in files.items():
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(data.encode() if isinstance(data, str) else data)
    return folder
