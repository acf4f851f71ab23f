"""The commands of setup.py in a build: those that colcon runs are imported once, and the others never."""

from __future__ import annotations

import importlib
from contextlib import suppress
from importlib import metadata
from types import SimpleNamespace
from typing import Any

_GROUP = "distutils.commands"
_RUN = frozenset(
    [
        *("build", "build_py", "build_scripts", "egg_info", "sdist"),
        *("install", "install_data", "install_egg_info", "install_lib", "install_scripts"),
        *("bdist_egg", "easy_install"),
    ]
)
"""The commands that colcon runs, and those that they run or import."""


def import_commands() -> None:
    """Import the commands that colcon runs, and let `setup.py --help-commands` import no others.

    colcon reads only the names of the commands. setuptools imports all of them to print their descriptions, and they
    import modules such as docutils. This takes 5 MB and a tenth of a second.
    """
    installed = frozenset(metadata.entry_points(group=_GROUP))
    standard = frozenset(importlib.import_module("distutils.command").__all__)
    for command in installed:
        if command.name in _RUN:
            with suppress(Exception):
                command.load()
    for name in _RUN & standard:
        with suppress(Exception):
            importlib.import_module(f"distutils.command.{name}")

    distribution: Any = importlib.import_module("setuptools.dist").Distribution
    print_commands = distribution.print_commands

    def print_names(self: Any) -> None:  # noqa: ANN401 - a Distribution
        """Print all commands, but the description of none that is installed. The package's own commands are loaded."""
        own = {command.name for command in metadata.entry_points(group=_GROUP) if command not in installed}
        for name in (standard | {command.name for command in installed}) - own:
            self.cmdclass.setdefault(name, SimpleNamespace(description="(not imported)"))
        print_commands(self)

    distribution.print_commands = print_names
