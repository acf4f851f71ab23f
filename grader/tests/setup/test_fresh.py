"""The commands of a fresh clone, in the environment in which the tests themselves run."""

from __future__ import annotations

import signal
from typing import TYPE_CHECKING

from grader.tests.setup.fresh import Clone

if TYPE_CHECKING:
    from pathlib import Path


def test_a_command_can_be_interrupted_although_the_tests_run_in_the_background(tmp_path: Path) -> None:
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        said = Clone(tmp_path, tmp_path).stop("{ echo begun; sleep 60; echo too late; }", "begun", signal.SIGINT)
    finally:
        signal.signal(signal.SIGINT, before)
    assert said == "begun\n"
