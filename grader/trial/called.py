"""Called: the result of one call to a student's function, or of one run of a student's program."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from grader.common.json_types import text

if TYPE_CHECKING:
    from collections.abc import Sequence

MOST_TEXT = 20_000
"""The maximum number of characters that are kept from each output."""
MOST_VALUES = 10
TOO_LATE = "too late"
"""The value of `ended` for a call that took too long."""


@dataclass(frozen=True)
class Called:
    """The result of the call with this id.

    `ended` describes how the process ended, such as "exit 0" or "signal 9". It is TOO_LATE if the call took too long,
    and empty if the call has no result. `values` are the numbers that a function returned, or None if it returned
    anything else or more than MOST_VALUES numbers. `kind` is the name of the type that a function returned. If the call
    raised an exception other than SystemExit, `kind` has the names of the exception's class and its bases, separated by
    spaces. `kind` has at most 100 characters.
    """

    id: str
    ended: str = ""
    stdout: str = ""
    stderr: str = ""
    values: tuple[float, ...] | None = None
    kind: str = ""


def called_from_json(data: dict[str, Any]) -> Called:
    """Create the result from plain data. Raises ValueError, TypeError or KeyError if `data` is invalid."""
    values = data["values"]
    try:
        numbers = None if values is None else tuple(float(each) for each in values[:MOST_VALUES])
    except OverflowError as error:
        message = f"a value of the call is too large: {error}"
        raise ValueError(message) from error
    names = ("id", "ended", "stdout", "stderr")
    id_, ended, stdout, stderr = (text(data[name])[:MOST_TEXT] for name in names)
    return Called(id_, ended, stdout, stderr, numbers, text(data["kind"])[:100])


def read_called(output: bytes, ids: Sequence[str]) -> tuple[Called, ...]:
    """Return the results of the calls with these ids, from the output of the cell.

    Lines that are not a valid result are ignored. A call without a valid line gets an empty result.
    """
    found: dict[str, Called] = {}
    for line in output.splitlines():
        try:
            called = called_from_json(json.loads(line))
        except (ValueError, TypeError, KeyError, RecursionError):
            continue
        found.setdefault(called.id, called)
    return tuple(found.get(id_, Called(id_)) for id_ in ids)
