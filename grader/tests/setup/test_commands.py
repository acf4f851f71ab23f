"""Tests of what the scripts of the commands do before they import a module of the grader."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import grader.setup

COMMANDS = Path(grader.setup.__file__).parent / "commands"
INTERRUPTED = """
import sys


class Interrupting:
    def find_spec(self, name, *_):
        if name.startswith("grader."):
            raise KeyboardInterrupt


sys.meta_path.insert(0, Interrupting())
"""


@pytest.mark.parametrize(
    ("name", "code"),
    [("grader", 130), ("ros2", 2), ("rqt", 130), ("rqt_console", 130), ("rqt_graph", 130), ("rqt_plot", 130)],
)
def test_ctrl_c_during_the_import_prints_no_traceback(tmp_path: Path, name: str, code: int) -> None:
    (tmp_path / "sitecustomize.py").write_text(INTERRUPTED)
    command = Path(shutil.copy(COMMANDS / name, tmp_path))
    python = tmp_path / "python3"
    python.write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
    for file in (command, python):
        file.chmod(0o755)
    done = subprocess.run(
        [str(command), "--help"],
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (code, "", "")
