from __future__ import annotations

import pytest

from grader.view.guard import Door, admitted, answer_headers, refusal


@pytest.mark.parametrize("host", ["127.0.0.1:4711", "localhost:4711", "localhost"])
def test_the_page_itself_may_come_in(host: str) -> None:
    assert refusal({"host": host}, live=False) is None
    assert refusal({"host": host, "origin": f"http://{host}"}, live=True) is None


@pytest.mark.parametrize(
    "host",
    ["", "evil.example", "evil.example:4711", "127.0.0.1.evil.example:4711", "0.0.0.0:4711", "localhost.:1", "::1"],
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


def test_what_says_no_origin_may_read_the_files_but_not_drive() -> None:
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
    assert [door.opens(shown) for shown in (code, code, "secret", "secret", "")] == [True, False, True, True, False]
