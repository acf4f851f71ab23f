"""Adds to a wheel what is beside the package in this repository: the course, and what a copy of it needs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

_FOLDERS = ("course", "exercises", "solutions")
_FILES = ("LICENSE", "Makefile", "pyproject.toml", "requirements.lock", ".gitignore", "COLCON_IGNORE")


class CourseHook(BuildHookInterface):  # type: ignore[type-arg]
    """Puts the course's folders into the wheel; an editable install finds them in the repository."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add the folders; hatchling calls this before it builds."""
        if version == "standard":
            # (An instructor's copy for students has no solutions.)
            there = [name for name in _FOLDERS if Path(self.root, name).is_dir()]
            build_data["force_include"] |= {name: f"grader/{name}" for name in there}
            build_data["force_include"] |= {name: f"grader/repository/{name}" for name in (*_FILES, "docs")}
