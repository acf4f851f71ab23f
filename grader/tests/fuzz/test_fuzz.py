"""Fixed inputs for every fuzzing target, read by the real child process with its limits."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from grader.tests.fuzz import runs
from grader.tests.fuzz.runs import Tally, table
from grader.tests.fuzz.targets import TARGETS
from grader.tests.no_ros import without_ros

if TYPE_CHECKING:
    from pathlib import Path

MOST = 4000
"""The length of an invented input (bytes). A changed seed has about the same length as before."""


@pytest.fixture(autouse=True)
def no_ros(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    without_ros(tmp_path, monkeypatch)


def changed(seed: bytes) -> st.SearchStrategy[bytes]:
    """Return a strategy for the seed with some bytes replaced, removed or inserted."""

    def change(start: int, length: int, new: bytes) -> bytes:
        return seed[:start] + new + seed[start + length :]

    return st.builds(change, st.integers(0, len(seed)), st.integers(0, 40), st.binary(max_size=40))


@pytest.mark.parametrize("name", TARGETS)
def test_whatever_is_handed_in_has_an_outcome(name: str) -> None:
    target = TARGETS[name]
    seeds = sorted(target.seeds(), key=len)[:4]

    @settings(
        max_examples=12,
        derandomize=True,
        deadline=None,
        database=None,
        phases=(Phase.explicit, Phase.generate),
        suppress_health_check=list(HealthCheck),
    )
    @given(st.one_of(st.binary(max_size=MOST), *map(changed, seeds)))
    def run(data: bytes) -> None:
        target.run(data)

    for seed in seeds:
        target.run(seed)
    run()


def test_the_runs_of_a_target_add_up(tmp_path: Path) -> None:
    (tmp_path / "install-tree/runs").mkdir(parents=True)
    for day, executions in (("24", 1000), ("25", 234)):
        run = f'{{"wall_s": 90.0, "cpu_s": 30.0, "executions": {executions}}}'
        (tmp_path / f"install-tree/runs/2026-11-{day}T07-00-00.json").write_text(run)
    tally = Tally(tmp_path / "names")
    for _ in range(3):
        tally.count()
    lines = table(tmp_path, ["install tree", "names", "reports"]).splitlines()[2:]
    assert lines[0] == "| `install tree` | 2 | 3.0 | 1.0 | 1,234 |"
    assert lines[1].startswith("| `names` | 1 | 0.0 |")
    assert lines[2] == "| `reports` | 0 | 0.0 | 0.0 | 0 |"


def test_a_run_that_cannot_be_read_is_left_out_and_named(tmp_path: Path) -> None:
    folder = tmp_path / "names/runs"
    folder.mkdir(parents=True)
    for hour, text in enumerate(("", "[]", '{"wall_s": 1.0}', '{"wall_s": 60.0, "cpu_s": 60.0, "executions": 5}')):
        (folder / f"{hour}.json").write_text(text)
    first, *more = table(tmp_path, ["names"]).splitlines()[2:]
    assert first == "| `names` | 1 | 1.0 | 1.0 | 5 |"
    assert more == ["", "Left out, because they cannot be read:", *(f"- {folder / name}.json" for name in "012")]


def test_a_run_that_is_killed_while_it_is_written_keeps_its_earlier_numbers(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(runs, "EVERY_S", 0.0)
    tally = Tally(tmp_path / "names")
    tally.count()

    def killed(path: Path, _: str) -> None:
        path.open("w").close()
        raise KeyboardInterrupt

    monkeypatch.setattr("pathlib.Path.write_text", killed)
    with pytest.raises(KeyboardInterrupt):
        tally.count()
    assert table(tmp_path, ["names"]).splitlines()[2:] == ["| `names` | 1 | 0.0 | 0.0 | 1 |"]
