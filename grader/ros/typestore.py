"""The message types for rosbags: the types of ROS 2 Jazzy, and the types in installed .msg files."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rosbags.interfaces import Nodetype
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from rosbags.typesys.store import Typestore


def jazzy_types() -> Typestore:
    """Return the types that rosbags includes for ROS 2 Jazzy. These types do not include the types of turtlesim."""
    return get_typestore(Stores.ROS2_JAZZY)


def register(store: Typestore, name: str, prefixes: Sequence[Path]) -> None:
    """Add a type and the types of its fields to the store, as defined by the .msg files under the prefixes.

    If the file of the type does not exist, the store does not change.
    """
    if name in store.types:
        return
    package, _, short = name.partition("/msg/")
    for prefix in prefixes:
        file = prefix / "share" / package / "msg" / f"{short}.msg"
        if file.is_file():
            types = get_types_from_msg(file.read_text(encoding="utf-8"), name)
            for _constants, fields in types.values():
                for _field, field in fields:
                    for part in _names(field):
                        register(store, part, prefixes)
            store.register({key: value for key, value in types.items() if key not in store.types})
            return


def _names(field: object) -> Iterator[str]:
    match field:
        case (Nodetype.NAME, str(name)):
            yield name
        case (Nodetype.ARRAY | Nodetype.SEQUENCE, ((_, _) as inner, _)):
            yield from _names(inner)
