from __future__ import annotations

import os
import py_compile
import re
import shutil
import subprocess
import sys
from importlib.util import cache_from_source
from pathlib import Path

from grader.setup.bootstrap import ROOT
from grader.setup.compiled_modules import remove_incomplete


def compiled(folder: Path, name: str, size: int | None = None) -> Path:
    """Compile a module and keep the first `size` bytes, as a full disk would."""
    (folder / f"{name}.py").write_text(f"print({name!r})\n" * 9)
    path = folder / "__pycache__" / f"{name}.cpython-311.pyc"
    py_compile.compile(str(folder / f"{name}.py"), cfile=str(path), doraise=True)
    path.write_bytes(path.read_bytes()[:size])
    return path


def test_only_incomplete_modules_are_removed(tmp_path: Path) -> None:
    (tmp_path / "room").mkdir()
    whole = compiled(tmp_path / "room", "whole")
    incomplete = [compiled(tmp_path, f"cut_{size}", size) for size in (0, 8, 16, 40)]
    remove_incomplete(tmp_path)
    assert whole.is_file()
    assert [path for path in incomplete if path.exists()] == []


def test_the_set_up_starts_with_modules_that_a_full_disk_truncated(tmp_path: Path) -> None:
    for room in ("setup", "common"):
        shutil.copytree(
            ROOT / "grader" / room, tmp_path / "grader" / room, ignore=shutil.ignore_patterns("__pycache__")
        )
    shutil.copy(ROOT / "grader" / "__init__.py", tmp_path / "grader")
    for path in tmp_path.rglob("*.py"):
        cache = Path(cache_from_source(str(path)))
        py_compile.compile(str(path), cfile=str(cache), doraise=True)
        os.truncate(cache, 20)
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    found = re.search(r"^SET_UP = \$\(STARTER\) (.+)$", makefile, re.MULTILINE)
    assert found
    done = subprocess.run(
        [sys.executable, *found[1].split(), "--help"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
