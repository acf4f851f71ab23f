"""The names of plotted fields, as in `rqt_plot`: a topic and a field of its messages, such as /turtle1/pose/x."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Any

from grader.ros import message_values
from grader.ros.failure import Ros2Error
from grader.ros.rendering import is_message

if TYPE_CHECKING:
    from collections.abc import Iterable

    from grader.graph.endpoints import Observed


def expand(typed: str) -> list[str]:
    """Return the fields that a user typed, such as "/turtle1/pose/x:y" or "/turtle1/pose/x,/turtle1/pose/y"."""
    found: list[str] = []
    for part in filter(None, (part.strip() for part in typed.split(","))):
        first, *more = part.split(":")
        found += [first, *(f"{first.rpartition('/')[0]}/{name}" for name in more)]
    return [name if name.startswith("/") else f"/{name}" for name in found]


def topic_of(name: str, topics: Iterable[str]) -> str | None:
    """Return the topic of a field (the longest topic name that is a prefix of the field's name), or None."""
    return max((topic for topic in topics if f"{name}/".startswith(f"{topic}/")), key=len, default=None)


def numeric(message: Any, path: str) -> list[str]:  # noqa: ANN401 - a message of rclpy's
    """Return the paths of the numeric values in a part of a message, such as ["linear.x", "linear.y"].

    Raises:
        Ros2Error: the message does not have the field, or the field has no numbers.
    """
    found = _numeric(message_values.field(message, path, complete=False) if path else message, path)
    if not found:
        what = f"'{path}' is not a number" if path else "The messages have no numbers"
        message = f"{what}. For an array, name an element, as in data[0]"
        raise Ros2Error(message)
    return found


def fields_of(observed: Observed) -> list[str]:
    """Return the names of all published numeric fields. Elements of arrays and fields of unknown types are omitted."""
    types = {end.topic: end.type for end in observed.ends if end.kind == "publisher"}
    found = []
    for topic, type_name in types.items():
        with suppress(Ros2Error):
            paths = numeric(message_values.load_type(type_name, "msg")(), "")
            found += [f"{topic}/{path.replace('.', '/')}" for path in paths]
    return found


def _numeric(value: Any, path: str) -> list[str]:  # noqa: ANN401
    if is_message(value):
        names = value.get_fields_and_field_types()
        return [leaf for name in names for leaf in _numeric(getattr(value, name), f"{path}.{name}".lstrip("."))]
    is_number = isinstance(value, (bool, int, float)) or (value is None and path.endswith("]"))
    return [path] if is_number or (hasattr(value, "dtype") and not hasattr(value, "__len__")) else []
