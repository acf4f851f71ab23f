"""Ctrl-C, and Ctrl-C again while the command is exiting."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
CODE = """
import atexit, os, signal
from grader.view import rqt_graph
from grader.view.rqt import commands

def stopped(*_):
    raise KeyboardInterrupt

rqt_graph._run = commands._serve = stopped
rqt_graph.hand_over = commands.hand_over = lambda *_: None
rqt_graph.see_to_environment = commands.see_to_environment = lambda _: None
atexit.register(os.kill, os.getpid(), signal.SIGINT)
raise SystemExit({main})
"""


@pytest.mark.parametrize("main", ["rqt_graph.main([])", "commands.rqt()", "commands.rqt_console()"])
def test_a_second_ctrl_c_while_the_command_exits_prints_nothing(main: str) -> None:
    done = subprocess.run(
        [sys.executable, "-c", CODE.format(main=main)], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "")
