"""A graded submission as a folder: everything that was saved is loaded again without a change."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise
from grader.checks.judge import judge
from grader.errors import UsageError
from grader.evidence import recording_format
from grader.evidence.evidence import Evidence, Run
from grader.evidence.tries import Tries, Try
from grader.tests.checks.made import every, evidence, good, recording

if TYPE_CHECKING:
    from pathlib import Path

CHALLENGES = find_exercise("07-challenges")


def some_trials() -> Evidence:
    """Return four trials: two completed, one in which the node made the simulator fail, and one that was not run."""
    runs = {
        "circle": Run(good()),
        "eight": Run(recording(every(0.1, 1.0, 1.0))),
        "square": Run(overwhelmed="MemoryError"),
    }
    return evidence(exercise=CHALLENGES, runs=runs)


def test_each_trial_comes_back_as_it_was(tmp_path: Path) -> None:
    given = some_trials()
    recording_format.save(tmp_path / "kept", given, "none", ())
    kept = recording_format.load(tmp_path / "kept", lambda _: CHALLENGES).evidence
    assert list(kept.runs) == ["circle", "eight", "square"]
    assert kept.runs["square"] == Run(overwhelmed="MemoryError")
    assert judge(kept) == judge(given)
    for trial in ("circle", "eight"):
        assert kept.from_trial(trial).commands == given.from_trial(trial).commands != ()


def test_what_was_tried_comes_back_so_that_a_report_can_tell_it_again(tmp_path: Path) -> None:
    tries = Tries((Try("rate", "timer-period", "passes", "-1\n+2"),), behind=1, stopped="at most 6 fixes are tested")
    recording_format.save(tmp_path / "kept", replace(some_trials(), tries=tries), "none", ())
    assert recording_format.load(tmp_path / "kept", lambda _: CHALLENGES).evidence.tries == tries


def test_a_recording_says_whether_the_code_ran_in_a_sandbox(tmp_path: Path) -> None:
    for confined in (True, False, None):
        folder = tmp_path / str(confined)
        recording_format.save(folder, some_trials(), "none", (), confined=confined)
        assert recording_format.load(folder, lambda _: CHALLENGES).confined is confined
    file = tmp_path / "True" / "submission.json"
    about = json.loads(file.read_text())
    file.write_text(json.dumps({name: value for name, value in about.items() if name != "confined"}))
    assert recording_format.load(tmp_path / "True", lambda _: CHALLENGES).confined is None  # an earlier version
    file.write_text(json.dumps({**about, "confined": "yes"}))
    with pytest.raises(UsageError, match="'yes' is neither true nor false"):
        recording_format.load(tmp_path / "True", lambda _: CHALLENGES)


def test_a_place_that_cannot_be_written_is_an_error_before_the_trial(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(UsageError, match="/file is not a folder that you can write to"):
        recording_format.check_free(tmp_path / "file/recording")
    recording_format.check_free(tmp_path / "new/recording")


def test_a_recording_of_an_older_grader_is_refused(tmp_path: Path) -> None:
    recording_format.save(tmp_path / "kept", some_trials(), "none", ())
    file = tmp_path / "kept" / "submission.json"
    file.write_text(json.dumps({**json.loads(file.read_text()), "schema": 1}))
    with pytest.raises(UsageError, match=r"submission\.json does not have schema 2"):
        recording_format.load(tmp_path / "kept", lambda _: CHALLENGES)
