"""Import numpy and catkin_pkg on first use, because the import takes 0.1 s and most commands do not need them.

Use `from grader.common.lazy import np` in modules that many commands import but only a few commands use. A module that
is first used in a child process is imported again in each child. `load_numpy` and `load_catkin_pkg` import the modules
before the fork, so that the child processes do not have to import the modules again.

If one thread forks while another thread imports numpy, the child process waits forever for an import that never
finishes (grader/submission/reader.py). Therefore, code that forks must hold the lock `IMPORTING`.
"""

from __future__ import annotations

import importlib
import sys
import threading
from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping

IMPORTING = threading.RLock()
"""This lock is held while numpy or catkin_pkg is imported, and while the process forks."""


_CONDITION = "catkin_pkg.condition"


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


class _LazyCatkin(_Lazy):
    """The module catkin_pkg.package, without the parser of conditions until a package.xml has a condition.

    The import of this parser takes longer than all other imports of catkin_pkg.
    """

    def load(self) -> ModuleType:
        with IMPORTING:
            sys.modules.setdefault(_CONDITION, _WithoutParser(_CONDITION))
            return importlib.import_module(self._name)


class _WithoutParser(ModuleType):
    """A stand-in for catkin_pkg.condition."""

    def evaluate_condition(self, condition: str | None, context: Mapping[str, str]) -> bool:
        """Return whether the condition of a tag is met.

        Raises:
            ValueError: the condition cannot be parsed.
        """
        if condition is None:
            return True
        with IMPORTING:
            if sys.modules[_CONDITION] is self:
                del sys.modules[_CONDITION]
            met: bool = importlib.import_module(_CONDITION).evaluate_condition(condition, context)
            return met


_NUMPY = _Lazy("numpy")
catkin_package: Any = _LazyCatkin("catkin_pkg.package")
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
