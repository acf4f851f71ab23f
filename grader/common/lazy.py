"""Import numpy and catkin_pkg on first use, because the import takes 0.1 s and most commands do not need them.

Use `from grader.common.lazy import np` in modules that many commands import but only a few commands use. A module that
is first used in a child process is imported again in each child. `load_numpy` and `load_catkin_pkg` import the modules
before the fork, so that the child processes do not have to import the modules again.

If one thread forks while another thread imports numpy, the child process waits forever for an import that never
finishes (grader/submission/reader.py). Therefore, code that forks must hold the lock `IMPORTING`.
"""

from __future__ import annotations

import importlib
import threading
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from types import ModuleType

IMPORTING = threading.RLock()
"""This lock is held while numpy or catkin_pkg is imported, and while the process forks."""


class _Lazy:
    """An object that takes the place of a module and imports the module on first use.

    Any thread can use this object.
    """

    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, attribute: str) -> Any:  # noqa: ANN401 - any member of the module
        return getattr(self.load(), attribute)

    def load(self) -> ModuleType:
        """Import the module now, unless it has already been imported."""
        with IMPORTING:
            return importlib.import_module(self._name)


_NUMPY = _Lazy("numpy")
catkin_package: Any = _Lazy("catkin_pkg.package")
"""The module catkin_pkg.package."""
if TYPE_CHECKING:
    import numpy as np
else:
    np = _NUMPY


def load_numpy() -> None:
    """Import numpy now rather than on first use, for example in a thread that runs in the background."""
    _NUMPY.load()


def load_catkin_pkg() -> None:
    """Import the parser of package.xml now, before forking processes that read submissions."""
    catkin_package.load()


__all__ = ["IMPORTING", "catkin_package", "load_catkin_pkg", "load_numpy", "np"]
