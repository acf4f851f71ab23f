"""See that a value of a JSON file is of the kind that we write there: somebody else may have written the file."""

from __future__ import annotations

from typing import TypeVar

T = TypeVar("T")
MOST = 1e9
"""No number of ours in a report is larger, or so far below 0."""


def text(value: object) -> str:
    """Return the value. Raises TypeError if it is not a string."""
    return _is(str, value)


def text_or_none(value: object) -> str | None:
    """Return the value. Raises TypeError if it is neither a string nor None."""
    return None if value is None else _is(str, value)


def whole_or_none(value: object) -> int | None:
    """Return the value. Raises TypeError if it is neither a whole number nor None."""
    return None if value is None else _is(int, value)


def number(value: object) -> float:
    """Return the value. Raises TypeError if it is not a number, ValueError if it is too large or not a number (NaN)."""
    if isinstance(value, int | float) and -MOST <= value <= MOST:  # NaN is not in between either
        return value
    message = f"{value!r:.40} is not a number that the grader writes"
    raise ValueError(message) if isinstance(value, int | float) else TypeError(message)


def _is(kind: type[T], value: object) -> T:
    if not isinstance(value, kind):
        message = f"{value!r:.40} is of the wrong type"
        raise TypeError(message)
    return value
