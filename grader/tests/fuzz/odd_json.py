"""Test how the grader reads its own JSON files if these contain unexpected values."""

from __future__ import annotations

import copy
import json
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.tests.fuzz.choices import Choices

ODD: tuple[Any, ...] = (
    *(None, True, -1, 2**64, 10**400, 1e300, float("inf"), float("nan"), "", "x", "\ud800", "\0", "9" * 5000),
    *([], {}, [None], {"a": 1}, [[[[]]]]),
)
Path = tuple[str | int, ...]
MOST_OF_A_LIST = 2


def paths(data: Any, path: Path = ()) -> Iterator[Path]:  # noqa: ANN401 - JSON
    """Yield the path to each value. For a list, yield only the first elements."""
    yield path
    inside = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in list(inside)[: None if isinstance(data, dict) else MOST_OF_A_LIST]:
        yield from paths(value, (*path, key))


def replaced(data: Any, path: Path, value: Any) -> bytes:  # noqa: ANN401 - JSON
    """Return the JSON with this value at the path."""
    if not path:
        return json.dumps(value).encode()
    changed = inner = copy.deepcopy(data)
    for key in path[:-1]:
        inner = inner[key]
    inner[path[-1]] = value
    return json.dumps(changed).encode()


def odd_json(text: bytes, choices: Choices) -> bytes:
    """Return the JSON with up to three values replaced."""
    for _ in range(1 + choices.below(3)):
        data = json.loads(text)
        text = replaced(data, choices.one_of(list(paths(data))), choices.one_of(ODD))
    return text
