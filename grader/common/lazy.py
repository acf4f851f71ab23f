"""Import numpy and catkin_pkg on first use, because the import takes 0.1 s and most commands do not need them.

Use `from grader.common.lazy import np` in modules that many commands import, although only a few commands need numpy. A
module that is first used in a child process is imported again in each child. `load_numpy` and `load_catkin_pkg` import
the modules before the fork, so that the child processes do not have to import the modules again.

If one thread forks while another thread imports numpy, the child process waits forever for an import that never
finishes (grader/submission/reader.py). Therefore, code that forks must hold the lock `IMPORTING`.
"""

from __future__ import annotations

import importlib
import os
import sys
import threading
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from grader.errors import MachineError

if TYPE_CHECKING:
    from collections.abc import Mapping

IMPORTING = threading.RLock()
"""This lock is held while numpy or catkin_pkg is imported, and while the process forks to read a submission."""


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
        """Import the module now, unless it has already been imported.

        Raises:
            MachineError: the module cannot be imported. No submission can cause this.
        """
        with IMPORTING:
            try:
                return importlib.import_module(self._name)
            except ImportError as error:
                raise MachineError(_why_not_imported(self._name, error)) from error


def _why_not_imported(name: str, error: ImportError) -> str:
    """Return a message that says why a module cannot be imported, and what to do."""
    top = name.partition(".")[0]
    why = " ".join(str(error).split())[:200].rstrip(".")
    entries = [entry for entry in os.environ.get("PYTHONPATH", "").split(os.pathsep) if entry]
    hiding = next((entry for entry in entries if any(Path(entry, file).exists() for file in (top, f"{top}.py"))), None)
    if hiding is not None:
        return f"{top} in {hiding} cannot be imported: {why}. Remove this folder from PYTHONPATH."
    return f"{top} cannot be imported: {why}. Run `make demo` in the course's folder."


class _LazyCatkin(_Lazy):
    """The module catkin_pkg.package, whose parser of conditions is imported only when a package.xml has a condition.

    The import of this parser takes longer than all other imports of catkin_pkg.
    """

    def load(self) -> ModuleType:
        with IMPORTING:
            sys.modules.setdefault(_CONDITION, _WithoutParser(_CONDITION))
            return super().load()


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
