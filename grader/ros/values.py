"""Values of messages: from what a user typed as YAML into a message, and from a message into YAML, CSV or text."""

from __future__ import annotations

import importlib
import re
from typing import TYPE_CHECKING, Any

import yaml

from grader.ros import index
from grader.ros.failure import Ros2Error, did_you_mean

if TYPE_CHECKING:
    from collections.abc import Iterator

TRUNCATED_AT = 128
"""Elements of an array, or characters of a string, that are printed unless all are asked for."""
_ARRAY = re.compile(r"sequence<(.+?)(?:, \d+)?>$|(.+)\[\d+\]$")


def load_type(name: str, kind: str, what: str) -> Any:  # noqa: ANN401
    """The Python class of an interface: "geometry_msgs/msg/Twist"; the middle may be left out.

    Raises:
        Ros2Error: it is not installed; `what` is what it was asked for as ("message type").
    """
    parts = name.split("/")
    package, last = parts[0], parts[-1]
    try:
        if parts not in ([package, last], [package, kind, last]):
            raise ModuleNotFoundError
        return getattr(importlib.import_module(f"{package}.{kind}"), last)
    except (ImportError, AttributeError, ValueError, TypeError) as error:
        known = index.all_interfaces(kind)
        ends = [full for full in known if full.endswith(f"/{last}")]
        text = f"The passed {what} is invalid"
        raise Ros2Error(did_you_mean(name, ends or known, text)) from error


def parse(text: str) -> dict[str, Any]:
    """What a user typed: "{linear: {x: 2.0}}".

    Raises:
        Ros2Error: it is not YAML, or not a dictionary.
    """
    try:
        values = yaml.safe_load(text)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = f" at character {mark.index + 1}" if mark is not None else ""
        problem = getattr(error, "problem", None) or "it cannot be read"
        message = (
            f"The passed value is not YAML: {problem}{where}.\n"
            'A value looks like "{linear: {x: 2.0}, angular: {z: 1.0}}": quotes around it, a blank after each colon.'
        )
        raise Ros2Error(message) from error
    if values is None:
        return {}
    if not isinstance(values, dict):
        message = "The passed value needs to be a dictionary in YAML format"
        if isinstance(values, str) and ":" in values:
            message += '\nA blank is needed after each colon: "{x: 2.0}".'
        raise Ros2Error(message)
    return values


def fill(message: Any, values: dict[str, Any]) -> Any:  # noqa: ANN401
    """Set the fields of a message that are named; the others keep their defaults. Returns the message.

    Raises:
        Ros2Error: there is no such field, or a value does not fit it.
    """
    types = message.get_fields_and_field_types()
    for name, value in values.items():
        if name not in types:
            text = f"Failed to populate field: '{type(message).__name__}' object has no attribute '{name}'"
            raise Ros2Error(did_you_mean(str(name), types, text))
        try:
            setattr(message, name, _converted(value, types[name], getattr(message, name)))
        except (AssertionError, TypeError, ValueError, OverflowError) as error:
            told = str(error) or f"the value {value!r} does not fit"
            failed = f"Failed to populate field: '{name}' ({types[name]}): {told}"
            raise Ros2Error(failed) from error
    return message


def _converted(value: Any, declared: str, current: Any) -> Any:  # noqa: ANN401
    if array := _ARRAY.match(declared):
        element = array[1] or array[2]
        if not isinstance(value, (list, tuple)):
            wrong = f"a list was expected, as in [1, 2], and {value!r} is none"
            raise TypeError(wrong)
        if "/" in element:
            made = load_type(element, "msg", "message type")
            return [_converted(item, element, made()) for item in value]
        return [_scalar(item, element) for item in value]
    if "/" in declared:
        if not isinstance(value, dict):
            wrong = f"its parts were expected, as in {{{_first(current)}: ...}}, and {value!r} are none"
            raise TypeError(wrong)
        return fill(current, value)
    return _scalar(value, declared)


def _first(message: Any) -> str:  # noqa: ANN401
    return next(iter(message.get_fields_and_field_types()), "")


def _scalar(value: Any, declared: str) -> Any:  # noqa: ANN401
    """A value of a primitive type; YAML reads 1e-3 as text and 2 as an integer, and both are numbers."""
    if isinstance(value, (dict, list)) or value is None:
        wrong = f"one value was expected, and {value!r} is none"
        raise TypeError(wrong)
    if declared in ("float", "double"):
        return float(value)
    if declared == "octet":
        return bytes([value])
    if declared.startswith(("string", "wstring")):
        return str(value)
    if declared == "boolean":
        if not isinstance(value, bool):
            wrong = f"true or false was expected, and {value!r} is neither"
            raise TypeError(wrong)
        return value
    if isinstance(value, bool) or not isinstance(value, int):
        wrong = f"a whole number was expected, and {value!r} is none"
        raise TypeError(wrong)
    return value


def plain(value: Any, limit: int | None = TRUNCATED_AT) -> Any:  # noqa: ANN401
    """A message as dictionaries, lists, numbers and text; longer than `limit` ends in "..."."""
    if hasattr(value, "get_fields_and_field_types"):
        return {name: plain(getattr(value, name), limit) for name in value.get_fields_and_field_types()}
    if isinstance(value, str):
        return value if limit is None or len(value) <= limit else value[:limit] + "..."
    if isinstance(value, (bytes, bytearray)):
        return value[0] if len(value) == 1 else plain(list(value), limit)
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        shown = [plain(item, limit) for item in value[:limit]]
        return shown if len(shown) == len(value) else [*shown, "..."]
    return value


def to_yaml(value: Any, limit: int | None = TRUNCATED_AT) -> str:  # noqa: ANN401
    """A message as block YAML, with the line break at its end; a single value as YAML writes it."""
    text: str = yaml.safe_dump(plain(value, limit), sort_keys=False, allow_unicode=True, width=float("inf"))
    return text.removesuffix("...\n")


def to_csv(value: Any, limit: int | None = TRUNCATED_AT) -> str:  # noqa: ANN401
    """The values of a message in the order of its fields, with commas between."""
    return ",".join(str(item) for item in _flat(plain(value, limit)))


def _flat(value: Any) -> Iterator[Any]:  # noqa: ANN401
    parts = value.values() if isinstance(value, dict) else value if isinstance(value, list) else None
    if parts is None:
        yield value
        return
    for part in parts:
        yield from _flat(part)


def field(value: Any, path: str) -> Any:  # noqa: ANN401
    """A part of a message: "linear.x", "poses[0].position".

    Raises:
        Ros2Error: there is no such field.
    """
    for part in re.findall(r"[^.\[\]]+|\[\d+\]", path):
        if part.startswith("["):
            try:
                value = value[int(part[1:-1])]
            except (IndexError, TypeError) as error:
                message = f"Invalid field '{path}': there is no element {part}"
                raise Ros2Error(message) from error
            continue
        known = value.get_fields_and_field_types() if hasattr(value, "get_fields_and_field_types") else {}
        if part not in known:
            owner = type(value).__name__
            raise Ros2Error(did_you_mean(part, known, f"Invalid field '{path}': '{owner}' has no field '{part}'"))
        value = getattr(value, part)
    return value
