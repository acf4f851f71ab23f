"""Decide whether a request is allowed.

A page from another site in the same browser can also send requests to 127.0.0.1. The guard rejects a request if its
Origin (the site of the page) or its Host (the name that the page used for this machine) is another one. A connection to
the simulator must have an Origin. In addition, pages of other sites do not have the token.
"""

from __future__ import annotations

import hmac
import re
import secrets
from typing import TYPE_CHECKING

from grader.view.peer import is_of_another_user

if TYPE_CHECKING:
    from collections.abc import Mapping

NAMES = ("127.0.0.1", "localhost")
"""The host names that a request for this machine may contain. All ports are allowed, since ssh may forward another
port."""
_HOST = re.compile(rf"({'|'.join(map(re.escape, NAMES))})(:\d+)?", re.ASCII)
"""Matches the Host header of a request. The content security policy of the response contains its value, so nothing
but a host and a port may match."""


def refusal(headers: Mapping[str, str], *, live: bool) -> str | None:
    """Return the reason for rejecting a request, or None if the request is allowed.

    `live` is True if the request opens the connection for reading the state and driving the turtles.
    """
    host = headers.get("host", "")
    if not _HOST.fullmatch(host):
        return f"This page is served only at {' and '.join(NAMES)}."
    origin = headers.get("origin")
    if origin is None and live:
        return "The request has no Origin header: only the page is allowed to connect."
    if origin is not None and origin != f"http://{host}":
        return "Pages from other sites are not allowed to connect."
    return None


def admitted(token: str, shown: str) -> bool:
    """Return whether the token is correct. The comparison takes the same time for all wrong tokens of equal length."""
    return hmac.compare_digest(token.encode(), shown.encode())


class Door:
    """Admits a page that has the token or a code that is valid only once.

    The browser that this process starts gets a code instead of the token, because every user of the machine can read
    command lines. Another user could be faster than the browser, so a code does not admit programs of other users.
    """

    def __init__(self, token: str) -> None:
        self.token = token
        self._codes: set[str] = set()

    def code(self) -> str:
        """Return a new code, with which one page can connect once."""
        made = secrets.token_urlsafe(16)
        self._codes.add(made)
        return made

    def opens(self, shown: str, client: tuple[str, int] | None) -> bool:
        """Return whether a page with this token or code may connect. A code is valid only once.

        `client` is the address and port of the page's end of the connection.
        """
        if shown in self._codes and not is_of_another_user(client):
            self._codes.discard(shown)
            return True
        return admitted(self.token, shown)


POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self' ws://{host}; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'; require-trusted-types-for 'script'; "
    "trusted-types 'none'"
)


def answer_headers(host: str) -> dict[str, str]:
    """Return the headers of every response of the application.

    With these headers, the page loads nothing from other sites, and other sites cannot embed the page.
    """
    return {
        "content-security-policy": POLICY.format(host=host),
        "x-content-type-options": "nosniff",
        "referrer-policy": "no-referrer",
        "cross-origin-opener-policy": "same-origin",
        "cross-origin-resource-policy": "same-origin",
        "cache-control": "no-store",
    }
