"""Limit the messages from a kernel to nbgrader: their format, number and size.

nbgrader keeps every message in memory: as text, as Python objects, and in the notebook that it writes. Therefore, the
budget limits the number of messages, their size in bytes, and the number of values in their JSON. For example,
`[[],[],[]]` needs more than 20 times as many bytes in memory as in the message.
"""

from __future__ import annotations

import hashlib
import hmac
import json
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NoReturn

from grader.notebook.frames import FrameError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

MIB = 1024 * 1024
DELIMITER = b"<IDS|MSG>"
"""The delimiter after the identities in a message: https://jupyter-client.readthedocs.io/en/stable/messaging.html"""
MOST_IDENTITIES = 4
MOST_DIGITS = 400
_HEADER = {"msg_id": str, "msg_type": str}


@dataclass(frozen=True)
class Budget:
    """The limits for the messages from the kernel of one notebook."""

    message: int = 4 * MIB
    """The maximum size of a message (bytes)."""
    total: int = 16 * MIB
    """The maximum total size of all messages (bytes)."""
    messages: int = 10_000
    values: int = 1_000_000
    """The maximum number of keys and values in the JSON of all messages."""
    depth: int = 50
    """The maximum nesting depth of objects and lists."""


@dataclass
class Account:
    """The totals of all messages that a kernel has sent. The kernel signs its messages with `key`."""

    key: bytes
    budget: Budget = Budget()
    _bytes: int = 0
    _values: int = 0
    _signatures: set[bytes] = field(default_factory=set)

    def take(self, parts: Sequence[bytes]) -> None:
        """Check a message and add it to the totals.

        Raises:
            FrameError: the data is not a message of Jupyter's protocol, or the budget is exceeded.
        """
        self._bytes += sum(map(len, parts))
        if self._bytes > self.budget.total:
            _refuse(f"more than {self.budget.total // MIB} MiB in all its messages")
        if len(self._signatures) >= self.budget.messages:
            _refuse(f"more than {self.budget.messages} messages")
        if DELIMITER not in parts[: MOST_IDENTITIES + 1]:
            _refuse()
        signature, *signed = parts[parts.index(DELIMITER) + 1 :][:5] or [b""]
        expected = hmac.new(self.key, b"".join(signed), hashlib.sha256).hexdigest().encode()
        if len(signed) < 4 or not hmac.compare_digest(signature, expected) or signature in self._signatures:
            _refuse()
        self._signatures.add(signature)
        read = [self._read(part) for part in signed]
        if not all(isinstance(read[0].get(name), kind) for name, kind in _HEADER.items()):
            _refuse()

    def _read(self, part: bytes) -> dict[str, Any]:
        """Parse a part of a message as a JSON object."""
        try:
            read = json.loads(
                part.decode("utf-8", "replace"), parse_int=_integer, parse_float=_number, parse_constant=_refuse
            )
        except (ValueError, RecursionError):
            _refuse()
        if not isinstance(read, dict):
            _refuse()
        self._count(read)
        return read

    def _count(self, read: dict[str, Any]) -> None:
        for value, depth in walk(read):
            self._values += 1
            if self._values > self.budget.values:
                _refuse(f"more than {self.budget.values} values in all its messages")
            if depth > self.budget.depth:
                _refuse(f"a message with objects nested more than {self.budget.depth} levels deep")
            if isinstance(value, str) and not _writable(value):
                _refuse()


def walk(read: object) -> Iterator[tuple[object, int]]:
    """Yield each key and value of parsed JSON together with its nesting depth. The depth of `read` itself is 1."""
    waiting = [(read, 1)]
    while waiting:
        value, depth = waiting.pop()
        yield value, depth
        if isinstance(value, dict):
            waiting += [(inner, depth + 1) for item in value.items() for inner in item]
        elif isinstance(value, list):
            waiting += [(inner, depth + 1) for inner in value]


def _refuse(what: str = "data that is not a Jupyter message") -> NoReturn:
    raise FrameError(what)


def _writable(text: str) -> bool:
    """Return whether the text can be encoded. Half of a surrogate pair cannot be encoded."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def _integer(digits: str) -> int:
    return int(digits) if len(digits) <= MOST_DIGITS else _refuse()


def _number(text: str) -> float:
    number = float(text)
    return number if math.isfinite(number) else _refuse()
