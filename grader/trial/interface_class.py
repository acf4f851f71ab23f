"""Load the Python class of an installed message or service type whose name comes from a node of a submission."""

from __future__ import annotations

import importlib
import re
from typing import TYPE_CHECKING, Any, Literal

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

_TYPE = re.compile(r"([a-z][a-z0-9_]*)/(msg|srv)/([A-Z][A-Za-z0-9]*)")


def load_class(type_name: str, kind: Literal["msg", "srv"], prefixes: Iterable[Path]) -> Any | None:  # noqa: ANN401
    """Return the class of an interface such as `geometry_msgs/msg/Twist`, or None if no prefix contains it.

    A submission chooses the name, so nothing is imported unless a prefix has an interface file of this name.
    """
    match = _TYPE.fullmatch(type_name)
    if match is None or match[2] != kind:
        return None
    package, _, name = match.groups()
    if not any((prefix / "share" / package / kind / f"{name}.{kind}").is_file() for prefix in prefixes):
        return None
    return getattr(importlib.import_module(f"{package}.{kind}"), name)
