"""Messages as YAML or CSV, in the format of `ros2 topic echo`."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cache
from typing import Any

TRUNCATED_AT = 128
"""The default maximum number of elements of an array, or characters of a string, that are printed."""
ARRAY = re.compile(r"sequence<(?P<sequence>.+?)(?:, (?P<most>\d+))?>|(?P<array>.+)\[(?P<size>\d+)\]")
"""Matches the types of fields that hold several values: "sequence<double>", "sequence<double, 5>", "double[36]"."""


@dataclass(frozen=True)
class Form:
    """How a message is printed: whether the values of arrays and strings are included, and how long they may be.

    An array has at most `limit` elements, and a string at most `limit` characters. None means no limit.
    """

    limit: int | None = TRUNCATED_AT
    arrays: bool = True
    strings: bool = True
    flow: bool = False
    """Whether an array is printed on one line, as in "[1, 2]"."""


def is_message(value: Any) -> bool:  # noqa: ANN401
    """Return whether the value is a message."""
    return hasattr(value, "get_fields_and_field_types")


def plain(value: Any, form: Form | None = None, declared: str = "") -> Any:  # noqa: ANN401
    """Convert a message to dictionaries, lists, numbers and strings.

    `declared` is the type of the field that contains the value, if any.
    """
    form = form or Form()
    if is_message(value):
        types = value.get_fields_and_field_types()
        return {name: plain(getattr(value, name), form, kind) for name, kind in types.items()}
    if isinstance(value, bytes):
        return _cut("".join(map(chr, value)), form.limit)
    if isinstance(value, str):
        return _cut(value, form.limit) if form.strings else _length(value)
    if isinstance(value, bool) or not hasattr(value, "__len__"):
        # Convert a numpy number to a Python number.
        return value.item() if hasattr(value, "item") else value
    if not form.arrays and declared:
        return _kind(declared, len(value))
    found = value.tolist() if hasattr(value, "tolist") else list(value)
    shown = [plain(item, form) for item in found[: form.limit]]
    return shown if len(shown) == len(found) else [*shown, "..."]


def to_yaml(value: Any, form: Form | None = None) -> str:  # noqa: ANN401
    """Return a message as YAML that ends with a newline."""
    form = form or Form()
    return dumped(plain(value, form), form)


def dumped(values: Any, form: Form) -> str:  # noqa: ANN401
    """Return plain dictionaries, lists, numbers and strings as YAML that ends with a newline."""
    import yaml

    text: str = yaml.dump(
        values, Dumper=_dumper(), sort_keys=False, allow_unicode=True, width=float("inf"), default_flow_style=form.flow
    )
    return text


@cache
def _dumper() -> Any:  # noqa: ANN401
    """Return a dumper that writes each field on a separate line, even in flow style, as the real `ros2` does."""
    import yaml

    class Dumper(yaml.SafeDumper):  # type: ignore[misc]
        pass

    Dumper.add_representer(
        dict,
        lambda dumper, data: yaml.MappingNode(
            "tag:yaml.org,2002:map",
            [(dumper.represent_data(name), dumper.represent_data(value)) for name, value in data.items()],
        ),
    )
    return Dumper


def on_one_line(value: Any) -> str:  # noqa: ANN401
    """Return a message on one line, in the format that `ros2 topic pub` accepts, as in "{linear: {x: 0.0}}".

    Long arrays and strings are truncated.
    """
    import yaml

    text: str = yaml.safe_dump(
        plain(value), sort_keys=False, allow_unicode=True, width=float("inf"), default_flow_style=True
    )
    return text.strip()


def to_csv(value: Any, form: Form | None = None, declared: str = "") -> str:  # noqa: ANN401
    """Return the values of a message in the order of its fields, separated by commas."""
    form = form or Form()
    if is_message(value):
        types = value.get_fields_and_field_types()
        return ",".join(to_csv(getattr(value, name), form, kind) for name, kind in types.items())
    if isinstance(value, str):
        return _cut(value, form.limit) if form.strings else _length(value)
    if isinstance(value, bytes):
        return str(value if form.limit is None or len(value) <= form.limit else value[: form.limit] + b"...")
    if isinstance(value, bool) or not hasattr(value, "__len__"):
        return str(value)
    if not form.arrays and declared:
        return _kind(declared, len(value))
    found = value.tolist() if hasattr(value, "tolist") else list(value)
    shown = [to_csv(item, form) for item in found[: form.limit]]
    return ",".join(shown if len(shown) == len(found) else [*shown, "..."])


def _cut(text: str, limit: int | None) -> str:
    return text if limit is None or len(text) <= limit else text[:limit] + "..."


def _length(text: str) -> str:
    return f"<string length: <{len(text)}>>"


def _kind(declared: str, length: int) -> str:
    """Return the description of an array that is printed instead of its values."""
    match = ARRAY.fullmatch(declared)
    if match is None:
        return declared
    element = re.sub(r"<\d+>$", "", match["sequence"] or match["array"])
    element = element.replace("/", "/msg/")
    if match["size"]:
        return f"<array type: {element}[{match['size']}]>"
    most = f"[{match['most']}]" if match["most"] else ""
    return f"<sequence type: {element}{most}, length: {length}>"
