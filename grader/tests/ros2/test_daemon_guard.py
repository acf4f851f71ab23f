"""Another user of the machine can neither use the daemon of a user nor offer a forged one."""

from __future__ import annotations

import os
import socket
from contextlib import contextmanager, suppress
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING

import pytest

from grader.ros2.daemon import client, socket_path
from grader.tests.observed_host import USER
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from collections.abc import Iterator

by_root = pytest.mark.skipif(os.geteuid() != 0, reason="only root can become another user")


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    return tmp_path / "grader"


@contextmanager
def another_user() -> Iterator[None]:
    os.seteuid(USER)
    try:
        yield
    finally:
        os.seteuid(0)


@contextmanager
def daemon(*, forged: bool) -> Iterator[None]:
    """Listen on the socket of the daemon, and answer one request."""
    private = socket_path.folder()
    assert private is not None
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as listening:
        with socket_path.address(private, f"{socket_path.name()}.socket") as place:
            listening.bind(place)
        if forged:
            with another_user():  # the kernel reports the user who has called listen(2)
                listening.listen()
        else:
            listening.listen()

        def answer() -> None:
            connection, _ = listening.accept()
            with connection, suppress(OSError):  # the client may have left
                connection.recv(64)
                connection.sendall(b'{"forged": true}')

        thread = Thread(target=answer, daemon=True)
        thread.start()
        yield
        thread.join(HANG_S)
        assert not thread.is_alive(), "no client has connected"


def test_the_daemon_of_this_user_is_asked(folder: Path) -> None:
    with daemon(forged=False):
        assert client.request("ping") == {"forged": True}
    assert folder.stat().st_mode & 0o777 == 0o700


@by_root
def test_the_daemon_of_another_user_is_not_asked(folder: Path) -> None:
    with daemon(forged=True):
        assert client.request("ping") is None
    assert folder.is_dir()


@by_root
def test_the_connection_of_another_user_is_recognized(tmp_path: Path) -> None:
    tmp_path.chmod(0o755)
    with socket.socket(socket.AF_UNIX) as listening, socket.socket(socket.AF_UNIX) as theirs:
        with socket_path.address(tmp_path, "socket") as place:
            listening.bind(place)
            listening.listen()
            (tmp_path / "socket").chmod(0o777)
            with another_user():
                theirs.connect(place)
        connection, _ = listening.accept()
        with connection:
            assert not socket_path.is_ours(connection)


@pytest.mark.parametrize("wrong", ["open to others", "a link", pytest.param("of another user", marks=by_root)])
def test_a_folder_that_others_could_have_made_is_not_used(folder: Path, tmp_path: Path, wrong: str) -> None:
    if wrong == "a link":
        (tmp_path / "elsewhere").mkdir(mode=0o700)
        folder.symlink_to("elsewhere")
    else:
        folder.mkdir(mode=0o700)
    if wrong == "open to others":
        folder.chmod(0o755)
    if wrong == "of another user":
        os.chown(folder, USER, USER)
    assert socket_path.folder() == tmp_path / "cache/grader/daemon"


def test_a_daemon_of_another_version_of_the_course_is_not_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    names = set()
    package = Path(socket_path.__file__).parents[2]
    for changed in ("", "graph/snapshot.py", "ros2/daemon/server.py"):
        for file in ("graph/snapshot.py", "ros2/daemon/server.py", "ros2/daemon/socket_path.py"):
            copy = tmp_path / file
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_bytes((package / file).read_bytes() + (b"# another version\n" if file == changed else b""))
        monkeypatch.setattr(socket_path, "__file__", str(tmp_path / "ros2/daemon/socket_path.py"))
        monkeypatch.setattr(socket_path, "version", socket_path.version.__wrapped__)
        names.add(socket_path.name())
        monkeypatch.undo()
    assert len(names) == 3
