"""Only the page itself can read the learner's work or start programs."""

from __future__ import annotations

import json
import socket
from contextlib import ExitStack
from http.client import HTTPConnection
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect
from websockets.typing import Origin

from grader.open.desk_server import LARGEST
from grader.tests.browser import new_page
from grader.tests.open.course import CIRCLE
from grader.tests.ros2.world import children
from grader.tests.waiting import HANG_S
from grader.view.connections import MOST

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

    from grader.tests.open.course import Course

HEADER = "X-Course-Token"


def answer(course: Course, method: str, path: str, headers: dict[str, str], body: bytes = b"") -> tuple[int, str]:
    """Send a request as given: the path is not normalized, and only Content-Length and a missing Host are added."""
    link = HTTPConnection("127.0.0.1", int(course.host.partition(":")[2]), timeout=HANG_S)
    link.putrequest(method, path, skip_host="Host" in headers, skip_accept_encoding=True)
    for name, value in headers.items():
        link.putheader(name, value)
    if body:
        link.putheader("Content-Length", str(len(body)))
    link.endheaders(body or None)
    got = link.getresponse()
    text = got.read().decode("utf-8", "replace")
    link.close()
    return got.status, text


def own(course: Course) -> dict[str, str]:
    """Return the headers that the page sends."""
    return {"Host": course.host, "Origin": f"http://{course.host}", HEADER: course.token}


def test_the_page_may_act_and_read(begun: Course) -> None:
    assert answer(begun, "POST", "/do/rerun", own(begun), b"{}") == (200, "{}")
    assert answer(begun, "GET", "/verdict", own(begun))[0] == 200


@pytest.mark.parametrize(
    "wrong",
    [
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Origin": "http://localhost:1"},
        {"Host": "evil.example"},
        {HEADER: ""},
        {HEADER: "x" * 22},
    ],
    ids=["other site", "opaque origin", "other port", "rebound name", "no token", "wrong token"],
)
def test_a_request_that_is_not_the_pages_is_refused(begun: Course, wrong: dict[str, str]) -> None:
    before = begun.node.read_text()
    for method, path in (("POST", "/do/start"), ("POST", "/do/hint"), ("GET", "/verdict")):
        status, text = answer(begun, method, path, {**own(begun), **wrong}, b'{"step": "next"}')
        assert status == 403
        assert begun.token not in text
        assert str(begun.workspace) not in text
    assert begun.node.read_text() == before


def evil(browser: Browser, body: str) -> Page:
    """Open a page of another site."""
    tab = new_page(browser)
    tab.route("http://evil.example/", lambda route: route.fulfill(body=body, content_type="text/html"))
    tab.goto("http://evil.example/")
    return tab


def test_a_form_of_another_site_changes_nothing(begun: Course, browser: Browser) -> None:
    form = f'<form method="post" action="http://{begun.host}/do/start"><input name="step" value="next"></form>'
    tab = evil(browser, form)
    with tab.expect_response(lambda response: "/do/start" in response.url) as sent:
        tab.evaluate("document.forms[0].submit()")
    assert sent.value.status == 403
    tab.close()


def test_a_script_of_another_site_can_neither_act_nor_read(begun: Course, browser: Browser) -> None:
    tab = evil(browser, "<p>evil</p>")
    for wanted in (f"/do/rerun', {{method: 'POST', headers: {{'{HEADER}': 'x'}}}}", "/verdict'", "/index.html'"):
        asked = f"fetch('http://{begun.host}{wanted}).then(() => 'answered', () => 'refused')"
        assert tab.evaluate(asked) == "refused"
    tab.close()


@pytest.mark.parametrize("token", ["", "x" * 22])
def test_the_news_need_the_token(begun: Course, token: str) -> None:
    with (
        pytest.raises(InvalidStatus) as refused,
        connect(f"ws://{begun.host}/live?token={token}", origin=Origin(f"http://{begun.host}")),
    ):
        pass
    assert refused.value.response.status_code == 403


@pytest.mark.parametrize(
    "path",
    [
        "/../pyproject.toml",
        "/assets/../../pyproject.toml",
        "/assets/%2e%2e/%2e%2e/pyproject.toml",
        "/03-circle-publisher/exercise.toml",
        "/03-circle-publisher/../../solutions/03-circle-publisher/my_robot_controller/setup.py",
        "//etc/passwd",
        "/%2fetc%2fpasswd",
        "/assets/open.html",
        "/assets/\x7f",
        "/" + "a" * 5000,
    ],
)
def test_a_path_leads_to_nothing_but_the_pages(begun: Course, path: str) -> None:
    link = socket.create_connection(("127.0.0.1", int(begun.host.partition(":")[2])), HANG_S)
    with link:
        link.sendall(f"GET {path} HTTP/1.1\r\nHost: {begun.host}\r\nConnection: close\r\n\r\n".encode())
        status = link.recv(65536).split(b"\r\n", 1)[0]
    assert b" 404 " in status or b" 400 " in status, status


@pytest.mark.parametrize(
    ("body", "status"),
    [
        (b" " * (LARGEST + 1), 413),
        (b"[]", 400),
        (b"{", 400),
        (b"\xff", 400),
        (b"[" * LARGEST, 400),
        (b'{"step": "../../x"}', 409),
        (b'{"step": ["03"]}', 409),
        (b'{"step": {"a": 1}}', 409),
        (b"{}", 409),
    ],
)
def test_an_odd_request_is_answered_with_a_sentence(begun: Course, body: bytes, status: int) -> None:
    got, text = answer(begun, "POST", "/do/start", own(begun), body)
    assert got == status
    assert json.loads(text)["problem"].endswith(".")


def test_there_is_no_other_action(begun: Course) -> None:
    assert answer(begun, "POST", "/do/__class__", own(begun))[0] == 404
    assert answer(begun, "GET", "/do/rerun", own(begun))[0] in (404, 405)


def test_clients_that_never_finish_do_not_stop_the_page(begun: Course) -> None:
    port = int(begun.host.partition(":")[2])
    slow = [socket.create_connection(("127.0.0.1", port), HANG_S) for _ in range(40)]
    for each in slow[:20]:
        each.sendall(b"GET / HTTP/1.1\r\nHost: ")
    head = "".join(f"{name}: {value}\r\n" for name, value in own(begun).items())
    for each in slow[20:]:
        each.sendall(f"POST /do/rerun HTTP/1.1\r\n{head}Content-Length: 100\r\n\r\n{{".encode())
    assert answer(begun, "GET", "/verdict", own(begun))[0] == 200
    # A request whose body never arrives also gets a response.
    assert b" 408 " in slow[-1].recv(65536)
    for each in slow:
        each.close()


def test_many_idle_connections_do_not_keep_the_page_out(begun: Course) -> None:
    """Another user of the machine can connect, too."""
    port = int(begun.host.partition(":")[2])
    with ExitStack() as stack:
        for number in range(2 * MOST + 100):
            idle = stack.enter_context(socket.create_connection(("127.0.0.1", port), HANG_S))
            if number % 3 == 1:
                idle.sendall(f"GET /assets/book.js HTTP/1.1\r\nHost: {begun.host}\r\n\r\n".encode())
            elif number % 3 == 2:
                idle.sendall(b"GET / HTTP/1.1\r\nHost: ")
        assert answer(begun, "GET", "/verdict", own(begun))[0] == 200
        assert len(list(Path(f"/proc/{server_of(begun)}/fd").iterdir())) < 1.5 * MOST


def server_of(course: Course) -> int:
    """Return the process that serves the page."""
    (pid,) = (pid for pid in children(course.processes[-1].pid) if b"grader.open" in command_line(pid))
    return pid


def command_line(pid: int) -> bytes:
    """Return the command line of a process, or nothing if it has ended: a grading starts and ends other processes."""
    try:
        return Path(f"/proc/{pid}/cmdline").read_bytes()
    except (FileNotFoundError, ProcessLookupError):
        return b""


def test_a_wrong_address_says_so(begun: Course, browser: Browser) -> None:
    tab = new_page(browser)
    tab.goto(f"http://{begun.host}/{CIRCLE}/index.html#{'x' * 22}")
    tab.get_by_text("Open the address that grader open has printed").wait_for()
    tab.close()
