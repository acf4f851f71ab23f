"""Add files from outside the package to a wheel: the course, and the files needed to create a copy of the course."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

_FOLDERS = ("course", "exercises", "solutions")
_FILES = ("LICENSE", "Makefile", "pyproject.toml", "requirements.lock", ".gitignore", ".gitattributes", "COLCON_IGNORE")


class CourseHook(BuildHookInterface):  # type: ignore[type-arg]
    """Adds the course's folders and files to the wheel. An editable install uses those in the repository instead."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add the folders and files, except to an editable install. hatchling calls this method before the build."""
        if version == "standard":
            # The repository for students has no solutions.
            there = [name for name in _FOLDERS if Path(self.root, name).is_dir()]
            build_data["force_include"] |= {name: f"grader/{name}" for name in there}
            build_data["force_include"] |= {name: f"grader/repository/{name}" for name in (*_FILES, "docs")}
