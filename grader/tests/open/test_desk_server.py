"""The responses to the actions of a page."""

from __future__ import annotations

import asyncio
import errno
import json
from typing import TYPE_CHECKING, Any

import pytest

from grader.common.updated import START_AGAIN
from grader.errors import UsageError
from grader.open import desk_server
from grader.open.desk_server import DeskServer
from grader.view.guard import Door

if TYPE_CHECKING:
    from collections.abc import Mapping


class Asked:
    """A request with a valid token and an empty JSON object."""

    headers: Mapping[str, str] = {"x-course-token": "token"}
    path_params: Mapping[str, str] = {"name": "act"}

    async def stream(self) -> Any:  # noqa: ANN401
        yield b"{}"


def response_to(error: Exception) -> tuple[int, str]:
    """Return the status and the problem in the response to an action that raises this error."""

    def act(_: Mapping[str, Any]) -> object:
        raise error

    server: Any = DeskServer(None, None, Door("token"), None, {"act": act}, None)  # type: ignore[arg-type]
    made = asyncio.run(server._act(Asked()))
    return made.status_code, json.loads(made.body)["problem"]


@pytest.mark.parametrize(
    ("error", "status", "problem"),
    [
        (UsageError("The step does not exist."), 409, "The step does not exist."),
        (OSError(errno.ENOSPC, "full", "/state"), 500, "The disk is full for /state"),
        (ValueError("odd"), 500, "Internal error in the grader, not a problem with your work: ValueError: odd."),
        (AssertionError(), 500, "not a problem with your work: AssertionError. Please report the error."),
        (TimeoutError("odd"), 500, "A system call of the grader failed"),
    ],
)
def test_an_error_of_an_action_is_not_reported_as_one_of_the_request(
    error: Exception, status: int, problem: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(desk_server, "updated", lambda: False)
    made_status, made_problem = response_to(error)
    assert made_status == status
    assert problem in made_problem


def test_an_error_after_an_update_names_the_update(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(desk_server, "updated", lambda: True)
    assert response_to(KeyError("withdrawn")) == (500, START_AGAIN)
    assert response_to(UsageError("The step does not exist.")) == (409, "The step does not exist.")
