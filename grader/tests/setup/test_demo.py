from __future__ import annotations

import json
import os
import time
from typing import TYPE_CHECKING

import pytest

from grader.learner import progress, steps
from grader.setup import demo
from grader.setup.bootstrap import Stamp

if TYPE_CHECKING:
    from pathlib import Path


def test_tells_the_seconds_of_a_set_up_of_this_command_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stamp = tmp_path / "stamp.json"
    stamp.touch()
    now = 1060.0
    os.utime(stamp, (1000, 1000))
    monkeypatch.setattr(time, "time", lambda: now)
    made = Stamp("/x", "wheels", "/usr/bin/python3", [3, 11, 2], "", [], {"download": 7.0})
    monkeypatch.setattr(demo, "STAMP", stamp)
    monkeypatch.setattr(demo, "read_stamp", lambda: made)
    assert demo.set_up_seconds(elapsed_s=61) == [("set-up, once: download", 7.0)]
    assert demo.set_up_seconds(elapsed_s=59) == []
    now = 900.0
    assert demo.set_up_seconds(elapsed_s=61) == []  # the clock was set back


def test_the_time_of_the_whole_command_does_not_follow_the_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    begun_s = demo.uptime_s()
    monkeypatch.setattr(time, "time", lambda: 0.0)
    assert 0 <= demo.uptime_s() - begun_s < 60


def test_reads_the_stages_of_the_grading(tmp_path: Path) -> None:
    report = tmp_path / "report.json"
    report.write_text(json.dumps({"seconds": {"build": 1.5, "trial": 2, "run": 1, "in all": 4}}))
    assert demo.grading_seconds(report) == [("colcon build", 1.5), ("simulator and node", 2.0)]


@pytest.mark.parametrize(
    ("shell", "begins_with_bash"), [("/bin/bash", False), ("/bin/zsh", False), ("/bin/fish", True)]
)
def test_a_shell_that_cannot_read_the_setup_file_starts_bash_first(
    monkeypatch: pytest.MonkeyPatch, shell: str, *, begins_with_bash: bool
) -> None:
    monkeypatch.setenv("SHELL", shell)
    assert ("\n    bash\n    source .venv/setup.bash\n" in demo.next_words()) == begins_with_bash


@pytest.mark.parametrize(("code", "words"), [(3, "grader doctor"), (1, "not your mistake")])
def test_a_failed_demo_says_whose_fault_it_is(code: int, words: str) -> None:
    assert words in demo.closing_words(code)


def test_a_learner_who_has_started_a_step_is_not_sent_to_the_first_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "state"))
    monkeypatch.setenv("ROS2_WORKSPACE", str(tmp_path / "ros2_ws"))
    assert demo.next_words().endswith("\n    grader start 01")
    steps.start("03", None)
    assert demo.next_words().endswith("\n    grader status")
    progress.state_file().write_text("{")
    assert demo.next_words().endswith("\n    grader start 01")
