"""Check that a value in a JSON file has the type that the grader writes. Other programs can change the file."""

from __future__ import annotations

from typing import TypeVar

T = TypeVar("T")
MOST = 1e9
"""The largest absolute value that `number` accepts. The numbers in the grader's reports are smaller."""


def text(value: object) -> str:
    """Return the value. Raises TypeError if the value is not a string."""
    return _is(str, value)


def text_or_none(value: object) -> str | None:
    """Return the value. Raises TypeError if the value is neither a string nor None."""
    return None if value is None else _is(str, value)


def whole_or_none(value: object) -> int | None:
    """Return the value. Raises TypeError if the value is neither an integer nor None."""
    return None if value is None else _is(int, value)


def number(value: object) -> float:
    """Return the value.

    Raises TypeError if the value is not a number, and ValueError if the value is too large or NaN.
    """
    if isinstance(value, int | float) and -MOST <= value <= MOST:  # false for NaN too
        return value
    message = f"{value!r:.40} is not a number, or is too large"
    raise ValueError(message) if isinstance(value, int | float) else TypeError(message)


def _is(kind: type[T], value: object) -> T:
    if not isinstance(value, kind):
        message = f"{value!r:.40} is of the wrong type"
        raise TypeError(message)
    return value
