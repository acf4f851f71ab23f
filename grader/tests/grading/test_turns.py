"""Graders share the machine.

A grader that needs the machine to itself waits for the other graders, and graders that start later wait for this
grader.
"""

from __future__ import annotations

import subprocess
import sys
from contextlib import ExitStack
from select import select
from typing import TYPE_CHECKING

from grader.grading import turns
from grader.grading.turns import Turns

if TYPE_CHECKING:
    from pathlib import Path

    import pytest

_OTHER = """
import sys
from pathlib import Path
from grader.grading.turns import Turns
mine = Turns(Path(sys.argv[1]), lambda _: "tells" in sys.argv and print("waits", flush=True))
with mine.shared():
    print("shared", flush=True)
    if "alone" in sys.argv:
        with mine.alone():
            print("alone", flush=True)
            sys.stdin.readline()
    sys.stdin.readline()
print("done", flush=True)
"""


def other(folder: Path, *how: str) -> subprocess.Popen[str]:
    """Start a process that holds the lock, like another grader."""
    return subprocess.Popen(
        [sys.executable, "-c", _OTHER, str(folder), *how], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )


def hears(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    return process.stdout.readline().strip()


def go_on(process: subprocess.Popen[str]) -> None:
    assert process.stdin is not None
    process.stdin.write("\n")
    process.stdin.flush()


def test_two_graders_share_the_machine(tmp_path: Path) -> None:
    with Turns(tmp_path).shared(), other(tmp_path) as second:
        assert hears(second) == "shared"
        go_on(second)


def test_an_exclusive_turn_waits_for_earlier_graders_and_later_graders_wait_for_it(tmp_path: Path) -> None:
    with ExitStack() as stack:
        with Turns(tmp_path).shared():
            alone = stack.enter_context(other(tmp_path, "alone", "tells"))
            assert [hears(alone), hears(alone)] == ["shared", "waits"]
            later = stack.enter_context(other(tmp_path, "tells"))
            go_on(later)
            assert hears(later) == "waits"
            assert alone.stdout is not None
            assert not select([alone.stdout], [], [], 0.1)[0], "the machine is not free yet"
        assert hears(alone) == "alone"
        assert later.poll() is None
        assert later.stdout is not None
        assert not select([later.stdout], [], [], 0.1)[0], "it came later"
        go_on(alone)
        go_on(alone)
        assert [hears(alone), hears(later), hears(later)] == ["done", "shared", "done"]


def test_two_exclusive_turns_follow_each_other(tmp_path: Path) -> None:
    with other(tmp_path, "alone") as one, other(tmp_path, "alone") as two:
        for process in (one, two):
            go_on(process)
            go_on(process)
        for process in (one, two):
            assert [hears(process), hears(process), hears(process)] == ["shared", "alone", "done"]


def test_a_killed_grader_releases_the_machine(tmp_path: Path) -> None:
    with other(tmp_path, "alone") as killed:
        assert [hears(killed), hears(killed)] == ["shared", "alone"]
        killed.kill()
    with other(tmp_path) as next_one:
        assert hears(next_one) == "shared"
        go_on(next_one)


def test_a_machine_that_does_not_become_free_is_used_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(turns, "WAIT_S", 0.05)
    with other(tmp_path) as busy:
        assert hears(busy) == "shared"
        told: list[str] = []
        mine = Turns(tmp_path, told.append)
        with mine.shared():
            assert told == []
            with mine.alone():
                assert busy.poll() is None
        assert told == ["Waiting until another grader on this machine has finished"]
        go_on(busy)


def test_a_grader_does_not_wait_if_the_lock_files_cannot_be_created(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    mine = Turns(tmp_path / "file" / "below")
    with mine.shared(), mine.alone():
        pass
