"""Values of messages: set fields from values that a user typed as YAML, and get fields by name."""

from __future__ import annotations

import importlib
import re
from collections.abc import Callable
from functools import partial
from typing import Any

from grader.ros import index
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros.rendering import ARRAY

Stamper = Callable[[Any], None]
"""A function that sets a field to a time stamp (builtin_interfaces/msg/Time)."""


def load_type(name: str, kind: str, what: str = "message type", text: str = "") -> Any:  # noqa: ANN401
    """Return the Python class of an interface such as "geometry_msgs/msg/Twist".

    The middle part of the name is optional. The name may come from another program or a bag, and an import runs the
    module. So nothing is imported unless an interface with this name is installed.

    Raises:
        Ros2Error: the interface is not installed. The message begins with `text`, or contains `what` if `text` is
            empty.
    """
    parts = name.split("/")
    package, last = parts[0], parts[-1]
    try:
        if parts not in ([package, last], [package, kind, last]) or not index.has_interface(package, kind, last):
            raise ModuleNotFoundError
        return getattr(importlib.import_module(f"{package}.{kind}"), last)
    except (ImportError, AttributeError, ValueError, TypeError) as error:
        known = index.all_interfaces(kind)
        ends = [full for full in known if full.endswith(f"/{last}")]
        raise Ros2Error(did_you_mean(name, ends or known, text or f"The passed {what} is invalid")) from error


def parse(text: str, *, dictionary: bool = True) -> Any:  # noqa: ANN401
    """Return the values that a user typed, such as "{linear: {x: 2.0}}". No value means an empty dictionary.

    Raises:
        Ros2Error: the string cannot be read as YAML, or `dictionary` is true and the value is not a dictionary.
    """
    import yaml

    try:
        values = yaml.safe_load(text)
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        where = f" at character {mark.index + 1}" if mark is not None else ""
        problem = getattr(error, "problem", None) or "it cannot be read"
        message = (
            f"The passed value is not YAML: {problem}{where}.\n"
            'A value looks like "{linear: {x: 2.0}, angular: {z: 1.0}}": quotes around it, a space after each colon.'
        )
        raise Ros2Error(message) from error
    except RecursionError as error:
        message = "The passed value is nested too deeply"
        raise Ros2Error(message) from error
    except ValueError as error:  # a value that looks like a date, such as 2027-13-01
        message = f"The passed value cannot be read: {error}"
        raise Ros2Error(message) from error
    if values is None:
        return {}
    if dictionary and not isinstance(values, dict):
        message = "The passed value needs to be a dictionary in YAML format"
        if isinstance(values, str) and ":" in values:
            message += '\nEach colon needs a space after it: "{x: 2.0}".'
        raise Ros2Error(message)
    return values


class MisfitError(Ros2Error):
    """The values do not match the message. `cause` is the error that Python would raise, and `help` may be a hint."""

    def __init__(self, cause: Exception, hint: str = "") -> None:
        self.cause = cause
        self.help = hint
        super().__init__("\n".join(part for part in (f"Failed to populate field: {cause}", hint) if part))


def fill(message: Any, values: Any, stamps: list[Stamper] | None = None) -> Any:  # noqa: ANN401
    """Set the fields of a message that are in `values`, and return the message. Other fields keep their values.

    If `stamps` is given, the value of a header may be "auto", and the value of a time may be "now". The functions that
    set these fields are appended to the list `stamps`.

    Raises:
        MisfitError: a name in `values` is not a field, a value does not match the type of its field, or `values` is not
            a dictionary.
        Ros2Error: the type of an array's elements is not installed.
    """
    types = message.get_fields_and_field_types()
    if not isinstance(values, dict):
        wrong = TypeError(f"Value '{values}' is expected to be a dictionary but is a {type(values).__name__}")
        field = next((name for name in types if name != _OF_AN_EMPTY_TYPE), "")
        raise MisfitError(
            wrong,
            f'A value looks like "{{{field}: ...}}".' if field else "This type has no fields, so its only value is {}.",
        )
    for name, value in values.items():
        if name not in types:
            unknown = AttributeError(f"'{type(message).__name__}' object has no attribute '{name}'")
            raise MisfitError(unknown, did_you_mean(str(name), types))
        current = getattr(message, name)
        if stamps is not None and _is_stamp(value, types[name]):
            stamps.append(partial(setattr, *((message, name) if value == "now" else (current, "stamp"))))
            continue
        try:
            setattr(message, name, _converted(value, types[name], current, stamps))
        except (AssertionError, TypeError, ValueError, OverflowError) as error:
            raise MisfitError(error, f"The field '{name}' has the type {types[name]}.") from error
    return message


_OF_AN_EMPTY_TYPE = "structure_needs_at_least_one_member"
"""The name of the field that rosidl adds to a message without fields."""
MOST_TEXT = 1000
"""The maximum length of a string and of an array in the result of `plain`."""


def plain(message: Any) -> Any:  # noqa: ANN401
    """Return a message, or the value of a field, as plain data. Long strings and arrays are truncated."""
    if hasattr(message, "get_fields_and_field_types"):
        return {name: plain(getattr(message, name)) for name in message.get_fields_and_field_types()}
    if isinstance(message, str):
        return message[:MOST_TEXT]
    if isinstance(message, bool | int | float):
        return message
    return [plain(each) for each in list(message)[:MOST_TEXT]]


def _is_stamp(value: Any, declared: str) -> bool:  # noqa: ANN401
    return (value, declared) in (("auto", "std_msgs/Header"), ("now", "builtin_interfaces/Time"))


def _converted(value: Any, declared: str, current: Any, stamps: list[Stamper] | None) -> Any:  # noqa: ANN401
    if array := ARRAY.fullmatch(declared):
        element = array["sequence"] or array["array"]
        if not isinstance(value, (list, tuple)):
            wrong = f"expected a list such as [1, 2], not {value!r}"
            raise TypeError(wrong)
        if "/" in element:
            made = load_type(element, "msg", "message type")
            return [fill(made(), item, stamps) for item in value]
        return [_scalar(item, element) for item in value]
    if "/" in declared:
        return fill(current, value, stamps)
    return _scalar(value, declared)


def _scalar(value: Any, declared: str) -> Any:  # noqa: ANN401
    """Return a value of a primitive type.

    YAML reads 1e-3 as a string and 2 as an integer, but both are valid floats.
    """
    if isinstance(value, (dict, list)) or value is None:
        wrong = f"expected a single value, not {value!r}"
        raise TypeError(wrong)
    if declared in ("float", "double"):
        return float(value)
    if declared == "octet":
        return bytes([value])
    if declared.startswith(("string", "wstring")):
        return str(value)
    if declared == "boolean":
        if not isinstance(value, bool):
            wrong = f"expected true or false, not {value!r}"
            raise TypeError(wrong)
        return value
    if isinstance(value, bool) or not isinstance(value, int):
        wrong = f"expected a whole number, not {value!r}"
        raise TypeError(wrong)
    return value


def field(value: Any, path: str, *, complete: bool = True) -> Any:  # noqa: ANN401
    """Return a part of a message, such as "linear.x" or "poses[0].position".

    The result is None if `complete` is false and an array is too short to contain the element.

    Raises:
        Ros2Error: the message has no such field or element.
    """
    for part in re.findall(r"[^.\[\]]+|\[\d+\]", path):
        if part.startswith("["):
            try:
                value = value[int(part[1:-1])]
            except (IndexError, TypeError) as error:
                if not complete and isinstance(error, IndexError):
                    return None
                message = f"Invalid field '{path}': there is no element {part}"
                raise Ros2Error(message) from error
            continue
        known = value.get_fields_and_field_types() if hasattr(value, "get_fields_and_field_types") else {}
        if part not in known:
            text = f"Invalid field '{path}': '{type(value).__name__}' object has no attribute '{part}'"
            raise Ros2Error(did_you_mean(part, known, text))
        value = getattr(value, part)
    return value
