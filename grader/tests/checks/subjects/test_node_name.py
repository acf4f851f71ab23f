"""A node with another name, because its entry point leads to another module."""

from __future__ import annotations

from dataclasses import replace

import pytest

from grader.tests.checks.made import BUILD, NODE_FILE, evidence, finding, submission
from grader.tests.checks.shapes import SHAPES


@pytest.mark.parametrize(
    ("module", "source", "found"), [("draw_square", "", True), ("draw_circle", "", False), ("draw_square", None, False)]
)
def test_an_entry_point_of_another_module_is_told(module: str, source: str | None, *, found: bool) -> None:
    package = submission({NODE_FILE: source, "my_robot_controller/draw_square.py": ""})
    build = replace(BUILD, entry_points={"draw_circle": f"my_robot_controller.{module}:main"})
    given = finding("node-name", evidence(SHAPES["other name"](), package, build=build))
    words = "The entry point draw_circle leads to draw_square.py, and the package also has a file draw_circle.py."
    assert (given.cause == words) == found
