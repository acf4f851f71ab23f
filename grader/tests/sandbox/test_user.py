"""If root grades, each cell has a separate user, and two cells at the same time have different users."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

import pytest

from grader.errors import MachineError
from grader.sandbox import bubblewrap, user
from grader.sandbox.limits import MOST_SIGNALS, Limits
from grader.sandbox.user import FEW_USERS, FIRST_USER, USERS, cell_user

SEEN = bubblewrap.View(())
ENV = {"PATH": "/usr/bin:/bin"}
as_root = pytest.mark.skipif(os.geteuid() != 0, reason="only root can become another user")
HOLDS = """
import sys
from grader.sandbox import user
user._users, user.PLACES = lambda _: range(65520, 65534), sys.argv[1:]
with user.cell_user() as mine:
    print(mine, flush=True)
    sys.stdin.read()
"""


@pytest.fixture
def few(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Provide a machine with few user ids and a separate lock file."""
    monkeypatch.setattr(user, "_users", lambda _: FEW_USERS)
    monkeypatch.setattr(user, "PLACES", (str(tmp_path),))


@as_root
@pytest.mark.usefixtures("few")
def test_two_cells_never_have_the_same_user_at_the_same_time() -> None:
    with ExitStack() as stack:
        users = [stack.enter_context(cell_user()) for _ in FEW_USERS]
        assert sorted(map(str, users)) == sorted(map(str, FEW_USERS))
        with pytest.raises(MachineError, match="All user ids for sandboxes are in use"):
            stack.enter_context(cell_user())
    with cell_user() as again:
        assert again in FEW_USERS


@as_root
@pytest.mark.usefixtures("few")
def test_two_graders_use_different_users(tmp_path: Path) -> None:
    argv, pipe = [sys.executable, "-c", HOLDS, str(tmp_path)], subprocess.PIPE
    others = [subprocess.Popen(argv, stdin=pipe, stdout=pipe) for _ in range(2)]
    try:
        theirs = {int(other.stdout.readline()) for other in others if other.stdout is not None}
        with ExitStack() as stack:
            mine = {stack.enter_context(cell_user()) for _ in range(len(FEW_USERS) - 2)}
        assert (len(theirs), theirs & mine) == (2, set())
    finally:
        for other in others:
            other.kill()
            other.communicate()


@as_root
def test_a_cell_has_its_user_outside_and_user_1000_inside() -> None:
    code = "import os; print(os.getuid(), os.stat('/proc/self').st_uid, flush=True); input()"
    view = bubblewrap.View((Path(sys.base_prefix), Path(sys.prefix)))
    with cell_user() as mine:
        argv = bubblewrap.lone_cell([sys.executable, "-I", "-c", code], view, env=ENV, limits=Limits(), user=mine)
        with subprocess.Popen(argv, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as cell:
            assert cell.stdout is not None
            said = cell.stdout.readline()
            users = {Path(f"/proc/{pid}").stat().st_uid for pid in family(cell.pid)}
    assert said == b"1000 1000\n"
    assert users == {0, mine}
    assert mine is not None
    assert FIRST_USER <= mine < FIRST_USER + USERS


def family(pid: int) -> list[int]:
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    return [pid, *(each for child in children for each in family(int(child)))]


def test_a_container_with_few_users_is_sufficient() -> None:
    assert user._users("0 0 4294967295\n") == range(FIRST_USER, FIRST_USER + USERS)
    assert user._users("0 100000 65536\n") == FEW_USERS


@as_root
def test_a_lock_file_that_others_can_change_is_refused(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(user, "PLACES", (str(tmp_path),))
    (tmp_path / "ros2-grader").mkdir()
    (tmp_path / "ros2-grader").chmod(0o777)
    with pytest.raises(MachineError, match="only you can open"), cell_user():
        pass


@pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")
def test_a_cell_cannot_use_up_pipes_timers_and_inotify_of_others() -> None:
    code = """
import ctypes, fcntl, json, os
libc, timer = ctypes.CDLL(None, use_errno=True), ctypes.c_void_p()
made = 0
while made < 5000 and libc.timer_create(1, None, ctypes.byref(timer)) == 0:
    made += 1
try:
    larger = fcntl.fcntl(os.pipe()[0], fcntl.F_SETPIPE_SZ, 1 << 20)
except PermissionError:
    larger = 0
print(json.dumps([made, larger, libc.inotify_init(), fcntl.fcntl(os.pipe()[0], fcntl.F_GETPIPE_SZ) > 0]))
"""
    from grader.tests.sandbox.test_bubblewrap import run

    assert json.loads(run(code).stdout) == [MOST_SIGNALS, 0, -1, True]
