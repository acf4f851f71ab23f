from __future__ import annotations

import os
import socket
import subprocess
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from grader.tests.observed_host import USER
from grader.view.guard import Door, admitted, answer_headers, refusal
from grader.view.serving import _SETTINGS

if TYPE_CHECKING:
    from collections.abc import Iterator


@pytest.mark.parametrize("host", ["127.0.0.1:4711", "localhost:4711", "localhost"])
def test_the_page_itself_may_come_in(host: str) -> None:
    assert refusal({"host": host}, live=False) is None
    assert refusal({"host": host, "origin": f"http://{host}"}, live=True) is None


@pytest.mark.parametrize(
    "host",
    [
        *("", "evil.example", "evil.example:4711", "127.0.0.1.evil.example:4711", "0.0.0.0:4711", "localhost.:1"),
        *("::1", "127.0.0.1:4711; script-src *", "127.0.0.1:x", "localhost:"),
    ],
)
def test_another_name_for_this_machine_is_refused(host: str) -> None:
    assert refusal({"host": host, "origin": f"http://{host}"}, live=True)
    assert refusal({"host": host}, live=False)


@pytest.mark.parametrize(
    "origin",
    ["http://evil.example", "http://127.0.0.1:80", "http://localhost:4711", "https://127.0.0.1:4711", "null", ""],
)
def test_another_origin_is_refused(origin: str) -> None:
    headers = {"host": "127.0.0.1:4711", "origin": origin}
    assert refusal(headers, live=True)
    assert refusal(headers, live=False)


def test_a_request_without_an_origin_may_read_files_but_not_drive() -> None:
    assert refusal({"host": "127.0.0.1:4711"}, live=False) is None
    assert refusal({"host": "127.0.0.1:4711"}, live=True)


def test_only_the_token_opens() -> None:
    assert admitted("secret", "secret")
    assert not any(admitted("secret", shown) for shown in ("", "secre", "secret ", "sécret"))


def test_the_policy_lets_nothing_in_from_elsewhere() -> None:
    policy = answer_headers("127.0.0.1:4711")["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy
    assert "frame-ancestors 'none'" in policy


def test_a_code_opens_once_and_the_token_always() -> None:
    door = Door("secret")
    code = door.code()
    assert [door.opens(shown, None) for shown in (code, code, "secret", "secret", "")] == [
        True,
        False,
        True,
        True,
        False,
    ]


CONNECTS = "import socket, sys; link = socket.create_connection(('127.0.0.1', int(sys.argv[1]))); sys.stdin.read()"


@contextmanager
def connected(*become: str) -> Iterator[tuple[str, int]]:
    """Connect from another process, which can belong to another user. Yield the address and port of its end."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        command = [*become, sys.executable, "-I", "-c", CONNECTS, str(server.getsockname()[1])]
        with subprocess.Popen(command, stdin=subprocess.PIPE) as program:
            link, client = server.accept()
            with link:
                yield client
            assert program.stdin is not None
            program.stdin.close()


def test_a_program_of_this_user_may_use_a_code() -> None:
    door = Door("secret")
    with connected() as client:
        assert door.opens(door.code(), client)


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can become another user")
def test_another_user_who_reads_the_command_line_cannot_use_its_code() -> None:
    door = Door("secret")
    code = door.code()
    with connected("setpriv", f"--reuid={USER}", f"--regid={USER}", "--clear-groups", "--") as client:
        assert door.opens("secret", client)
        assert not door.opens(code, client)
    assert door.opens(code, None), "the browser can still use it"


def test_a_client_cannot_choose_its_address() -> None:
    assert _SETTINGS["proxy_headers"] is False
