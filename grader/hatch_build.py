"""What a wheel holds beside the package: the course, which in a checkout lies beside it."""

from __future__ import annotations

from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class CourseHook(BuildHookInterface):  # type: ignore[type-arg]
    """Puts the course's folders into the package; an editable install finds them where they are."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add the folders, called by hatchling before it builds."""
        if version == "standard":
            build_data["force_include"] |= {name: f"grader/{name}" for name in ("course", "exercises", "solutions")}
