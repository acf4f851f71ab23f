"""Read tables of a TOML file key by key, and collect all mistakes as messages for the author of the file."""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING, Any

from grader.common.words import line_at, nearest, shorten
from grader.errors import UsageError

if TYPE_CHECKING:
    import re
    from collections.abc import Callable, Iterable

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

SETTING = (bool, int, float, str)
"""The possible types of a node's parameter."""


def read_toml(data: bytes, name: str) -> dict[str, Any]:
    """Return the tables of a TOML file. Raises UsageError if the file is not TOML.

    Some editors on Windows write a byte order mark, which is not part of TOML and is ignored.
    """
    try:
        return tomllib.loads(data.decode("utf-8-sig"))
    except UnicodeDecodeError as error:
        line = line_at(data, error.start)
        message = f"{name}: invalid TOML: line {line} is not UTF-8. Save the file as UTF-8."
        raise UsageError(message) from error
    except tomllib.TOMLDecodeError as error:
        message = f"{name}: invalid TOML: {error}."
        raise UsageError(message) from error


class Table:
    """A table that is being read. Mistakes are added to `problems`.

    A key that has not been read when `finish` is called counts as unknown. After a mistake, a method returns the
    default of the key or, if there is none, an empty value or 0.
    """

    def __init__(self, values: dict[str, Any], place: str, problems: list[str]) -> None:
        self.values = values
        self.place = place
        self.problems = problems
        self.known: list[str] = []

    def problem(self, text: str) -> None:
        """Record a mistake in this table."""
        self.problems.append(f"{self.place}: {text}" if self.place else text)

    def _get(self, key: str, allowed: str, good: Callable[[object], bool], *, default: Any) -> Any:  # noqa: ANN401 (any value that `good` accepts)
        """Return the value of the key if `good(value)` is true, or else the default.

        A wrong value is recorded as a mistake. A missing key is a mistake only if the default is None.
        """
        self.known.append(key)
        if key not in self.values:
            if default is None:
                self.problem(f'the key "{key}" is missing; it must be {allowed}.')
            return default
        value = self.values[key]
        if good(value):
            return value
        self.problem(f'"{key}" is {shown(value)}; it must be {allowed}.')
        return default

    def string(
        self,
        key: str,
        pattern: re.Pattern[str] | None = None,
        allowed: str = "a string that is not blank",
        default: str | None = None,
    ) -> str:
        """Return a string that matches `pattern` completely and is not blank."""

        def good(value: object) -> bool:
            return (
                isinstance(value, str) and bool(value.strip()) and (pattern is None or bool(pattern.fullmatch(value)))
            )

        return str(self._get(key, allowed, good, default=default) or "")

    def number(self, key: str, low: float, high: float, allowed: str, default: float | None = None) -> float:
        """Return a finite number with low <= number <= high."""

        def good(value: object) -> bool:
            is_number = isinstance(value, int | float) and not isinstance(value, bool)
            return is_number and math.isfinite(value) and low <= value <= high  # type: ignore[arg-type, operator]

        return float(self._get(key, allowed, good, default=default) or 0.0)

    def whole(self, key: str, low: int, high: int, default: int | None = None) -> int:
        """Return a whole number with low <= number <= high."""

        def good(value: object) -> bool:
            is_whole = isinstance(value, int) or (isinstance(value, float) and value.is_integer())
            return is_whole and not isinstance(value, bool) and low <= value <= high  # type: ignore[operator]

        return int(self._get(key, f"a whole number from {low} to {high}", good, default=default) or 0)

    def limits(self, key: str, least: float, most: float) -> tuple[float, float]:
        """Return two finite numbers from `least` to `most`, in ascending order.

        A single number in the file counts as both limits.
        """

        def good(value: object) -> bool:
            pair = value if isinstance(value, list) else [value, value]
            numbers = [n for n in pair if isinstance(n, int | float) and not isinstance(n, bool) and least <= n <= most]
            return len(pair) == len(numbers) == 2 and numbers[0] <= numbers[1]

        allowed = f"a number from {least:g} to {most:g}, or a list of two such numbers in ascending order"
        value = self._get(key, allowed, good, default=None)
        low, high = value if isinstance(value, list) else (value or 0.0, value or 0.0)
        return float(low), float(high)

    def flag(self, key: str) -> bool:
        """Return True or False. The default is False."""
        return bool(self._get(key, "true or false", lambda value: isinstance(value, bool), default=False))

    def strings(self, key: str) -> tuple[str, ...]:
        """Return the strings in a list. The default is an empty tuple."""

        def good(value: object) -> bool:
            return isinstance(value, list) and all(isinstance(item, str) for item in value)

        return tuple(self._get(key, "a list of strings", good, default=[]))

    def numbers(self, key: str, most: float) -> tuple[float, ...]:
        """Return the numbers in a list, which may be empty. The numbers must be finite and from -most to most."""

        def good(value: object) -> bool:
            return isinstance(value, list) and all(
                isinstance(each, int | float) and not isinstance(each, bool) and abs(each) <= most for each in value
            )

        allowed = f"a list of numbers from {-most:g} to {most:g}"
        return tuple(float(each) for each in self._get(key, allowed, good, default=None) or ())

    def options(self, key: str) -> tuple[Any, ...]:
        """Return the values in a list: at least two different values, either only strings or only numbers."""

        def good(value: object) -> bool:
            if not isinstance(value, list) or len(value) != len(set(map(repr, value))) or len(value) < 2:
                return False
            numbers = all(isinstance(each, int | float) and not isinstance(each, bool) for each in value)
            return numbers or all(isinstance(each, str) for each in value)

        return tuple(
            self._get(key, "a list of at least two numbers or strings, which all differ", good, default=["", ""])
        )

    def setting(self, key: str) -> Any:  # noqa: ANN401 - one of four types
        """Return the value of a node's parameter: true or false, a number, or a string."""
        allowed = "true or false, a number, or a string"
        value = self._get(key, allowed, lambda value: isinstance(value, SETTING), default=None)
        return 0 if value is None else value

    def settings(self, key: str) -> dict[str, Any]:
        """Return a table with parameters of a node. The default is an empty table."""

        def good(value: object) -> bool:
            return isinstance(value, dict) and all(
                isinstance(each, bool | int | float | str) for each in value.values()
            )

        return dict(self._get(key, "a table with numbers, strings, true or false", good, default={}))

    def anything(self, key: str) -> dict[str, Any]:
        """Return a table that may have any content. The default is an empty table."""
        return dict(self._get(key, "a table", lambda value: isinstance(value, dict), default={}))

    def table(self, key: str) -> Table:
        """Return the table `[key]`, which is required."""
        value = self._get(key, f"a table [{key}]", lambda value: isinstance(value, dict), default=None)
        return Table(value or {}, f"[{key}]", self.problems if value is not None else [])

    def tables(self, key: str) -> list[Table]:
        """Return the tables `[[key]]`. The default is an empty list."""

        def good(value: object) -> bool:
            return isinstance(value, list) and all(isinstance(item, dict) for item in value)

        values = self._get(key, f"an array of tables, [[{key}]]", good, default=[])
        return [Table(value, f"[[{key}]] {place}", self.problems) for place, value in enumerate(values, start=1)]

    def finish(self, also: Iterable[str] = ()) -> None:
        """Record every unknown key as a mistake."""
        allowed = [*self.known, *also]
        for key in self.values:
            if key not in allowed:
                guess = nearest(key, allowed)
                hint = f' Did you mean "{guess}"?' if guess else ""
                self.problem(f'unknown key "{shorten(key)}".{hint} Allowed: {", ".join(allowed)}.')


def shown(value: object) -> str:
    """Return a TOML value in the form in which a message quotes it."""
    if isinstance(value, str):
        return f'"{shorten(value)}"'
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict | list):
        return "a table" if isinstance(value, dict) else "a list"
    return shorten(str(value))
