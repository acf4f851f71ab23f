"""Who may come in: only this machine's own page. Pure.

A page from elsewhere in the same browser can send requests to 127.0.0.1 too. What tells it apart: the browser names
where it came from (Origin) and under which name it found this machine (Host), and it does not know the token.
"""

from __future__ import annotations

import hmac
import secrets
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping

NAMES = ("127.0.0.1", "localhost")
"""Names under which this machine is itself; any port, since ssh may lead another one here."""


def refusal(headers: Mapping[str, str], *, live: bool) -> str | None:
    """Why a request is turned away; None when it may come in. `live`: for the connection that reads and drives."""
    host = headers.get("host", "")
    if host.rpartition(":")[0] not in NAMES and host not in NAMES:
        return f"This page is served to {' and '.join(NAMES)} only."
    origin = headers.get("origin")
    if origin is None and live:
        return "No Origin: this is for the page only."
    if origin is not None and origin != f"http://{host}":
        return "Pages from elsewhere may not come in."
    return None


def admitted(token: str, shown: str) -> bool:
    """Whether the token that was shown is ours; takes as long for every wrong one."""
    return hmac.compare_digest(token.encode(), shown.encode())


class Door:
    """Opens to who knows the token, and to a code once.

    A code is for the browser that is started here: command lines can be read by every user of the machine.
    """

    def __init__(self, token: str) -> None:
        self.token = token
        self._codes: set[str] = set()

    def code(self) -> str:
        """A new code."""
        made = secrets.token_urlsafe(16)
        self._codes.add(made)
        return made

    def opens(self, shown: str) -> bool:
        """Whether who shows this may come in; a code is worth nothing afterwards."""
        if shown in self._codes:
            self._codes.discard(shown)
            return True
        return admitted(self.token, shown)


POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src 'self' ws://{host}; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'; require-trusted-types-for 'script'; "
    "trusted-types 'none'"
)


def answer_headers(host: str) -> dict[str, str]:
    """What every answer says: load nothing from elsewhere, be loaded by nobody else."""
    return {
        "content-security-policy": POLICY.format(host=host),
        "x-content-type-options": "nosniff",
        "referrer-policy": "no-referrer",
        "cross-origin-opener-policy": "same-origin",
        "cross-origin-resource-policy": "same-origin",
        "cache-control": "no-store",
    }
