from __future__ import annotations

import socket
from contextlib import closing
from typing import TYPE_CHECKING

import pytest

from grader.errors import UsageError
from grader.view.address import listen

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(autouse=True)
def state(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    return tmp_path / "grader/view-turtlesim.json"


def test_it_is_bound_to_this_machine_only() -> None:
    with closing(listen("turtlesim").listening) as listening:
        assert listening.getsockname()[0] == "127.0.0.1"


def test_the_next_view_has_the_address_of_the_last() -> None:
    first = listen("turtlesim")
    first.listening.close()
    second = listen("turtlesim")
    second.listening.close()
    assert second.address == first.address
    assert (first.before, second.before) == (False, True)


def test_a_second_view_beside_the_first_has_another_port_and_the_first_keeps_its_own() -> None:
    first = listen("turtlesim")
    with closing(listen("turtlesim").listening) as second:
        assert second.getsockname()[1] != first.address.port
    first.listening.close()
    with closing(listen("turtlesim").listening) as third:
        assert third.getsockname()[1] == first.address.port


def test_kinds_of_view_do_not_share_a_token() -> None:
    turtlesim, graph = listen("turtlesim"), listen("graph")
    turtlesim.listening.close()
    graph.listening.close()
    assert turtlesim.address.token != graph.address.token


def test_the_token_is_for_its_user_alone(state: Path) -> None:
    first = listen("turtlesim")
    first.listening.close()
    assert state.stat().st_mode & 0o777 == 0o600
    state.chmod(0o644)
    second = listen("turtlesim")
    second.listening.close()
    assert second.address.token != first.address.token


@pytest.mark.parametrize("text", ["", "[]", '{"port": "x", "token": 3}', '{"port": 1, "token": ""}', '{"other": 1}'])
def test_an_invalid_address_file_is_replaced(state: Path, text: str) -> None:
    state.parent.mkdir(parents=True)
    state.write_text(text)
    state.chmod(0o600)
    place = listen("turtlesim")
    place.listening.close()
    assert len(place.address.token) >= 22
    assert place.address.port > 1023


def test_the_view_starts_even_if_its_address_cannot_be_stored(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path / "file"))
    listen("turtlesim").listening.close()


def test_a_port_that_cannot_be_had_is_reported() -> None:
    with closing(socket.create_server(("127.0.0.1", 0))) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(UsageError, match=f"--port {port} is not available"):
            listen("turtlesim", port)
    with pytest.raises(UsageError, match="0 to 65535"):
        listen("turtlesim", 70000)
