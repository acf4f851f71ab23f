from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING

import pytest

from grader.setup import demo
from grader.setup.bootstrap import Stamp

if TYPE_CHECKING:
    from pathlib import Path


def test_tells_the_seconds_of_a_set_up_of_this_command_only(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    stamp = tmp_path / "stamp.json"
    stamp.touch()
    os.utime(stamp, (1000, 1000))
    made = Stamp("/x", "wheels", "/usr/bin/python3", [3, 11, 2], "", [], {"download": 7.0})
    monkeypatch.setattr(demo, "STAMP", stamp)
    monkeypatch.setattr(demo, "read_stamp", lambda: made)
    assert demo.set_up_seconds(since=999) == [("set-up, once: download", 7.0)]
    assert demo.set_up_seconds(since=1001) == []


def test_reads_the_stages_of_the_grading(tmp_path: Path) -> None:
    report = tmp_path / "report.json"
    report.write_text(json.dumps({"seconds": {"build": 1.5, "trial": 2, "run": 1, "in all": 4}}))
    assert demo.grading_seconds(report) == [("colcon build", 1.5), ("simulator and node", 2.0)]


@pytest.mark.parametrize(("code", "words"), [(3, "grader doctor"), (1, "not your mistake")])
def test_a_failed_demo_says_whose_fault_it_is(code: int, words: str) -> None:
    assert words in demo.closing_words(code)
