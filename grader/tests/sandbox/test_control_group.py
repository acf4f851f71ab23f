"""If control groups are allowed, the kernel limits the total resource use of a cell.

If control groups are not allowed, the cell has no control group.
"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from grader.sandbox import control_group as module
from grader.sandbox.control_group import ControlGroup, control_group
from grader.sandbox.limits import MIB, Limits

SMALL = Limits(total_memory=64 * MIB)
HOARD = "x = bytearray({mib} * 1024 * 1024); print(len(x) // 1024 // 1024)"


@pytest.fixture
def group() -> ControlGroup:
    with control_group(SMALL) as made:
        if not made:
            pytest.skip("the kernel does not allow a control group here")
    return made


def hoard(group: ControlGroup, mib: int) -> subprocess.CompletedProcess[str]:
    argv = group.joined([sys.executable, "-c", HOARD.format(mib=mib)])
    return subprocess.run(argv, capture_output=True, text=True, check=False)


@pytest.mark.usefixtures("group")
def test_a_group_over_its_limit_is_ended_and_this_is_reported() -> None:
    with control_group(SMALL) as group:
        assert hoard(group, 100).stdout == "100\n"
        assert not group.out_of_memory()
        assert hoard(group, 64 + 512 + 100).returncode == -9
        assert group.out_of_memory()


@pytest.mark.usefixtures("group")
def test_the_memory_of_several_processes_counts_together() -> None:
    # Start two processes, each of which uses more than half of the allowed memory.
    half = f"{sys.executable} -c 'x = bytearray({340 * MIB}); import time; time.sleep(60)'"
    with control_group(SMALL) as group:
        script = f"{half} & {half} & wait -n; kill $(jobs -p) 2>/dev/null; wait"
        subprocess.run(group.joined(["bash", "-c", script]), check=False, capture_output=True)
        assert group.out_of_memory()


@pytest.mark.usefixtures("group")
def test_a_group_is_removed_afterwards() -> None:
    with control_group(SMALL) as group:
        assert all(folder.is_dir() for folder in group.folders)
        assert subprocess.run(group.joined(["true"]), check=False).returncode == 0
    assert not any(folder.exists() for folder in group.folders)


@pytest.mark.usefixtures("group")
def test_the_group_of_a_killed_grader_is_removed_by_the_next_one() -> None:
    script = """
from grader.sandbox.control_group import control_group
from grader.sandbox.limits import Limits
import os, signal
with control_group(Limits()) as group:
    print(*(folder for folder in group.folders if folder.is_dir()), flush=True)
    os.kill(os.getpid(), signal.SIGKILL)
"""
    left = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False).stdout.split()
    assert left  # the groups may be gone by now, because each grader on this machine removes what others have left
    with control_group(SMALL):
        assert not any(Path(folder).exists() for folder in left)


def test_without_groups_the_command_runs_unchanged(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(module, "OWN", tmp_path / "no such file")
    monkeypatch.setattr(module, "TREE", tmp_path / "nor this")
    with control_group(SMALL) as group:
        assert not group
        assert group.joined(["true", "-x"]) == ["true", "-x"]
        assert not group.out_of_memory()


# Not every machine has version 2 with systemd's tree, so the tests create its files in a folder.


def version_2(folder: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Create the control group tree of a user's terminal, in which the upper slice delegates the controllers."""
    slice_ = folder / "user.slice/user-1000.slice/user@1000.service/app.slice"
    scope = slice_ / "terminal.scope"
    scope.mkdir(parents=True)
    for place in (slice_, scope):
        (place / "cgroup.procs").write_text("")
        (place / "cgroup.subtree_control").write_text("cpu memory pids\n" if place == slice_ else "\n")
    (folder / "own").write_text(f"0::/{scope.relative_to(folder)}\n")
    monkeypatch.setattr(module, "OWN", folder / "own")
    monkeypatch.setattr(module, "TREE", folder)
    return slice_


def test_in_version_2_the_group_is_in_the_slice_that_passes_controllers_on(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    slice_ = version_2(tmp_path, monkeypatch)
    with control_group(SMALL) as group:
        assert [folder.parent for folder in group.folders] == [slice_]
        (group.folders[0] / "memory.events").write_text("low 0\noom 3\noom_kill 2\n")
        assert group.out_of_memory()
        (group.folders[0] / "memory.events").unlink()
    assert not any(group.folders[0].parent.glob("grader-*"))


def test_in_version_2_a_slice_of_another_user_is_not_used(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if os.getuid() == 0:
        monkeypatch.setattr(os, "access", lambda *_: False)  # root can write everywhere
    slice_ = version_2(tmp_path, monkeypatch)
    (slice_ / "cgroup.procs").chmod(0o400)
    with control_group(SMALL) as group:
        assert not group
