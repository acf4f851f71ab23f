"""A process finds out that the modules of the grader have changed since it was started."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from grader import cli
from grader.common import updated as tested

if TYPE_CHECKING:
    import pytest

LONG_AGO = 1.0


def test_only_a_file_that_was_changed_after_the_start_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tested, "_modules", lambda: [os.__file__, str(tmp_path / "removed.py")])
    assert not tested.updated()
    new = tmp_path / "new.py"
    new.touch()
    os.utime(new, (LONG_AGO, LONG_AGO))  # as archives do
    monkeypatch.setattr(tested, "_modules", lambda: [os.__file__, str(new)])
    assert tested.updated()


def test_a_change_after_now_is_not_an_update(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "new.py").touch()
    monkeypatch.setattr(tested, "_modules", lambda: [str(tmp_path / "new.py")])
    now = time.time()
    monkeypatch.setattr(time, "time", lambda: now - 7200.0)  # somebody has set the clock back
    assert not tested.updated()


def test_a_machine_that_tells_no_start_hides_no_other_error(monkeypatch: pytest.MonkeyPatch) -> None:
    def no_more_files() -> float:
        raise OSError(errno.EMFILE, os.strerror(errno.EMFILE))

    monkeypatch.setattr(tested, "_start", no_more_files)
    assert not tested.updated()


def test_the_start_is_that_of_the_process() -> None:
    code = "import time; from grader.common.updated import _start; print(_start(), time.time())"
    before = time.time()
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    start, now = map(float, done.stdout.split())
    assert before - 0.02 <= start <= now


def test_an_interruption_between_the_clocks_does_not_change_the_start(monkeypatch: pytest.MonkeyPatch) -> None:
    start, clock, interruptions_s = tested._start(), time.time, [1.0]

    def interrupted() -> float:
        time.sleep(interruptions_s.pop() if interruptions_s else 0.0)
        return clock()

    monkeypatch.setattr(time, "time", interrupted)
    assert abs(tested._start() - start) < 0.5
    assert not interruptions_s


def test_the_modules_are_those_that_commands_import() -> None:
    found = {Path(path).relative_to(Path(cli.__file__).parent).as_posix() for path in tested._modules()}
    assert {"cli.py", "trial/conductor.py", "checks/judge.py"} <= found
    assert not [path for path in found if path.startswith(("tests/", "benchmarks/"))]


def test_an_error_after_an_update_names_the_update(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cli, "updated", lambda: False)
    assert cli._explain(KeyError("withdrawn")) is None
    monkeypatch.setattr(cli, "updated", lambda: True)
    said = cli._explain(KeyError("withdrawn"))
    assert said == (
        "the course was updated while this command was running (KeyError: 'withdrawn'). Type the command again."
    )
