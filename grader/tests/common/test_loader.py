"""A program that its dynamic loader runs behaves as usual, but /proc/PID/exe is the loader."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from grader.common.interpreter import interpreter
from grader.common.loader import loaded

if TYPE_CHECKING:
    from pathlib import Path

SELF = """
import json, os, sys
print(json.dumps([sys.executable, sys.prefix, sys.argv, os.path.realpath("/proc/self/exe")]))
"""


def test_the_interpreter_runs_as_usual_but_its_file_cannot_be_reached() -> None:
    start = interpreter("-c", SELF, "one", "two")
    command = loaded(start.argv)
    done = subprocess.run(command, env=start.env, capture_output=True, text=True, check=True)
    executable, prefix, arguments, file = json.loads(done.stdout)
    assert (executable, prefix, arguments) == (sys.executable, sys.prefix, ["-c", "one", "two"])
    assert file == os.path.realpath(command[0])
    assert file != os.path.realpath(sys.executable)


@pytest.mark.parametrize("content", [b"#!/bin/sh\n", b"", b"\x7fELF", b"\x7fELF\x02\x01" + bytes(100)])
def test_a_program_without_a_loader_is_started_directly(tmp_path: Path, content: bytes) -> None:
    program = tmp_path / "program"
    program.write_bytes(content)
    assert loaded([str(program), "argument"]) == [str(program), "argument"]
