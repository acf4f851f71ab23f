"""On a terminal, the progress disappears before the report.

If the output is not a terminal, the progress is printed line by line on standard error.
"""

from __future__ import annotations

import io
import sys
from typing import TYPE_CHECKING

from grader.report.progress_line import progress

if TYPE_CHECKING:
    import pytest

ERASE = "\x1b[2K"


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_terminal_shows_what_is_already_wrong_only_until_the_report_says_it(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = Terminal()
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stderr", terminal)
    with progress() as tell:
        tell.keep_all(["Already wrong in the files: the build type"])
        tell("Building with colcon")
    shown = terminal.getvalue()
    assert "Building with colcon" in shown
    assert ERASE in shown[shown.rindex("Already wrong in the files") :]


def test_a_pipe_gets_a_line_for_each(monkeypatch: pytest.MonkeyPatch) -> None:
    pipe = io.StringIO()
    monkeypatch.setattr(sys, "stderr", pipe)
    with progress() as tell:
        tell.keep_all(["Already wrong in the files: the build type"])
        tell("Building with colcon")
    assert pipe.getvalue().splitlines() == ["Already wrong in the files: the build type", "Building with colcon ..."]
