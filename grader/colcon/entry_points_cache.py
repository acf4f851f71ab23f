"""`importlib.metadata.entry_points` with a cache, for the runs of setup.py in a build."""

from __future__ import annotations

import re
import sys
from importlib import metadata
from itertools import chain
from pathlib import Path
from typing import Any


class EntryPoints:
    """`importlib.metadata.entry_points` with a cache.

    The original function reads the metadata of every package on each call, up to fifteen times per run of setup.py.
    EntryPoints reads the metadata of the installed packages once. On most later calls, it reads only the metadata in
    other folders on sys.path, such as the folder of the submission.
    """

    def __init__(self) -> None:
        self._read = metadata.entry_points
        self._fixed = frozenset(sys.path)
        self._names = frozenset(name for folder in sys.path for name in _with_metadata(folder))
        self._all: Any = self._read()
        self._groups: dict[str, list[metadata.EntryPoint]] = {}

    def __call__(self, **chosen: Any) -> Any:  # noqa: ANN401 - as the original
        """Return the entry points that have these attributes."""
        others = {folder: _with_metadata(folder) for folder in sys.path if folder not in self._fixed}
        group = chosen.pop("group", None)
        if group is None and not any(others.values()):
            return self._all.select(**chosen)
        if group is None or not self._names.isdisjoint(name for names in others.values() for name in names):
            return self._read(**({"group": group} if group else {}), **chosen)
        if group not in self._groups:
            self._groups[group] = list(self._all.select(group=group))
        folders = [folder for folder, names in others.items() if names]
        found = [each.entry_points.select(group=group) for each in metadata.distributions(path=folders)]
        return metadata.EntryPoints([*chain.from_iterable(found), *self._groups[group]]).select(**chosen)


def _with_metadata(folder: str) -> list[str]:
    """Return the names of the packages whose metadata is in the folder."""
    try:
        names = [path.name for path in Path(folder).iterdir()]
    except OSError:
        return []
    found = [name for name in names if name.endswith((".dist-info", ".egg-info", ".egg"))]
    return [re.sub(r"[-_.]+", "_", name.rpartition(".")[0].partition("-")[0]).lower() for name in found]
