"""Tables of a TOML file, read key by key; every problem is noted in words for the file's author."""

from __future__ import annotations

import math
import sys
from typing import TYPE_CHECKING, Any

from grader.common.words import nearest, shorten
from grader.errors import UsageError

if TYPE_CHECKING:
    import re
    from collections.abc import Callable, Iterable

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


def read_toml(data: bytes, name: str) -> dict[str, Any]:
    """The tables of a TOML file. Raises UsageError where it is none."""
    try:
        return tomllib.loads(data.decode("utf-8"))
    except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        message = f"{name}: not TOML: {error}."
        raise UsageError(message) from error


class Table:
    """A table of the file while it is read: what is wrong goes into `problems`, what was asked for is known."""

    def __init__(self, values: dict[str, Any], place: str, problems: list[str]) -> None:
        self.values = values
        self.place = place
        self.problems = problems
        self.known: list[str] = []

    def problem(self, text: str) -> None:
        """Note what is wrong with this table."""
        self.problems.append(f"{self.place}: {text}" if self.place else text)

    def _get(self, key: str, allowed: str, good: Callable[[object], bool], *, default: Any) -> Any:  # noqa: ANN401 (whatever `good` lets pass)
        """The value of the key where `good(value)`, else the default, and the problem noted."""
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

    def text(
        self, key: str, pattern: re.Pattern[str] | None = None, allowed: str = "a text", default: str | None = None
    ) -> str:
        """A text that is not blank, and is all of `pattern`."""

        def good(value: object) -> bool:
            return (
                isinstance(value, str) and bool(value.strip()) and (pattern is None or bool(pattern.fullmatch(value)))
            )

        return str(self._get(key, allowed, good, default=default) or "")

    def number(self, key: str, low: float, high: float, allowed: str, default: float | None = None) -> float:
        """A finite number, low <= number <= high."""

        def good(value: object) -> bool:
            is_number = isinstance(value, int | float) and not isinstance(value, bool)
            return is_number and math.isfinite(value) and low <= value <= high  # type: ignore[arg-type, operator]

        return float(self._get(key, allowed, good, default=default) or 0.0)

    def limits(self, key: str, most: float) -> tuple[float, float]:
        """Two finite numbers from -most to most, in order; one number stands for both."""

        def good(value: object) -> bool:
            pair = value if isinstance(value, list) else [value, value]
            numbers = [n for n in pair if isinstance(n, int | float) and not isinstance(n, bool) and abs(n) <= most]
            return len(pair) == len(numbers) == 2 and numbers[0] <= numbers[1]

        value = self._get(key, f"a number from {-most:g} to {most:g}, or a list of two in order", good, default=None)
        low, high = value if isinstance(value, list) else (value or 0.0, value or 0.0)
        return float(low), float(high)

    def flag(self, key: str) -> bool:
        """True or false; false when it is left out."""
        return bool(self._get(key, "true or false", lambda value: isinstance(value, bool), default=False))

    def texts(self, key: str) -> tuple[str, ...]:
        """A list of strings; empty when it is left out."""

        def good(value: object) -> bool:
            return isinstance(value, list) and all(isinstance(item, str) for item in value)

        return tuple(self._get(key, "a list of texts", good, default=[]))

    def table(self, key: str) -> Table:
        """A table `[key]`, which must be there."""
        value = self._get(key, f"a table [{key}]", lambda value: isinstance(value, dict), default=None)
        return Table(value or {}, f"[{key}]", self.problems if value is not None else [])

    def tables(self, key: str) -> list[Table]:
        """The tables `[[key]]`, none when they are left out."""

        def good(value: object) -> bool:
            return isinstance(value, list) and all(isinstance(item, dict) for item in value)

        values = self._get(key, f"tables [[{key}]]", good, default=[])
        return [Table(value, f"[[{key}]] {place}", self.problems) for place, value in enumerate(values, start=1)]

    def finish(self, also: Iterable[str] = ()) -> None:
        """Note every key that nobody asked for."""
        allowed = [*self.known, *also]
        for key in self.values:
            if key not in allowed:
                guess = nearest(key, allowed)
                hint = f' Did you mean "{guess}"?' if guess else ""
                self.problem(f'unknown key "{shorten(key)}".{hint} Allowed: {", ".join(allowed)}.')


def shown(value: object) -> str:
    """A TOML value as its author wrote it, nearly."""
    if isinstance(value, str):
        return f'"{shorten(value)}"'
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict | list):
        return "a table" if isinstance(value, dict) else "a list"
    return shorten(str(value))
