"""Run the command blocks of a Markdown text, to test that README and the lessons show the real output.

A line `...` matches any number of lines. The real output can have more lines at the end than the page shows. Numbers
may differ, except numbers of things, such as points.
"""

from __future__ import annotations

import re
import shlex
import subprocess
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from grader.authoring.console_blocks import Block, Step

COUNTED = r"(?:of|points?|scores?|submissions?|students?|checks?|differences|(?:not )?passed|failed|to grade|changed)"
NUMBER = re.compile(rf"(?<!\d)(?<!\d/)\d+(?:\.\d+)?(?!\.?\d)(?!/\d)(?! {COUNTED}\b)")
"""A number that may differ from run to run, such as a time. A number of points, such as 10/10, may not."""
MINUTES = re.compile(r"\b(?:\d+h )?\d+min (?=\d+s\b)")
"""What colcon puts before the seconds of a build that took more than a minute, as in "1min 13s"."""
END = "--- the end of what one command printed ---"


def run(block: Block, cwd: Path, env: Mapping[str, str], timeout_s: float) -> list[tuple[Step, str, int]]:
    """Run the block's commands in one shell. Return each command with its output and its exit code."""
    steps = block.steps()
    script = "\n".join(f"{step.command}\nprintf '\\n%s %s\\n' {shlex.quote(END)} $?" for step in steps)
    done = subprocess.run(
        ["bash", "--norc", "-c", script],
        cwd=cwd,
        env=env,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=timeout_s,
        check=False,
    )
    parts = re.split(rf"\n{END} (\d+)\n", done.stdout.decode("utf-8", "replace"))
    return [(step, parts[2 * index], int(parts[2 * index + 1])) for index, step in enumerate(steps)]


def differs(shown: tuple[str, ...], printed: str) -> str | None:
    """Return the first expected line that is missing from the output, or None.

    Of the numbers, only numbers of things, such as points, are compared.
    """
    lines = [_plain(line) for line in printed.splitlines()]
    at, jump = 0, True
    for line in shown:
        if line.strip() == "...":
            jump = True
            continue
        wanted = _plain(line)
        found = lines.index(wanted, at) if jump and wanted in lines[at:] else at
        if found >= len(lines) or lines[found] != wanted:
            return line
        at, jump = found + 1, False
    return None


def _plain(line: str) -> str:
    return " ".join(NUMBER.sub("#", MINUTES.sub("", line)).split())
