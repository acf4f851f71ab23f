"""The package that `pkg create` creates, as data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path


@dataclass(frozen=True)
class NewPackage:
    """The properties of the new package. `node` and `library` are None if no node or library is to be created."""

    name: str
    folder: Path
    shown: str
    """The folder as shown in messages, for example "./my_package"."""
    build_type: str
    package_format: int
    description: str
    maintainer: str
    email: str
    license: str
    dependencies: tuple[str, ...]
    node: str | None
    library: str | None
