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


NAME = "draw_cirle"
"""The name of the node in the recording, which is not the name that the exercise requires."""
NAMED = "class {}({}):\n    def __init__(self):\n        super().__init__({})\n"
IMPORTS = "from my_robot_controller.other import Other\n"
RUNS = "def main():\n    node = {}()\n"


@pytest.mark.parametrize(
    ("source", "other", "words", "line"),
    [
        (
            NAMED.format("Circle", "Node", f'"{NAME}"'),
            "",
            "The node name is the first argument of super().__init__.",
            3,
        ),
        (
            NAMED.format("Circle", "Node", '"draw_circle"') + f'rclpy.init(args=["--ros-args", "__node:={NAME}"])\n',
            "",
            "This remapping rule gives the node another name.",
            4,
        ),
        (
            NAMED.format("Circle", "Node", '"draw_circle"') + 'rclpy.init(args=["--ros-args", "cmd_vel:=x"])\n',
            "",
            "The node name is the first argument of super().__init__.",
            3,
        ),
        (
            NAMED.format("Circle", "Node", f'"{NAME}"') + f'print("Start it with --ros-args -r __node:={NAME}")\n',
            "",
            "The node name is the first argument of super().__init__.",
            3,
        ),
        (
            NAMED.format("Circle", "Node", f'"{NAME}"') + 'OTHER = "__node:=draw_circle"\n',
            "",
            "The node name is the first argument of super().__init__.",
            3,
        ),
        (
            IMPORTS + NAMED.format("Circle", "Other", ""),
            NAMED.format("Other", "Node", f'"{NAME}"'),
            f"Circle inherits the name {NAME} from Other, which passes it to its base class.",
            2,
        ),
        (
            IMPORTS + NAMED.format("Circle", "Other", '"draw_circle"') + RUNS.format("Circle"),
            NAMED.format("Other", "Node", f'"{NAME}"'),
            "The node name is the first argument of super().__init__.",
            3,
        ),
        (
            IMPORTS + RUNS.format("Other"),
            NAMED.format("Other", "Node", f'"{NAME}"'),
            f"main creates an object of Other, whose node has the name {NAME}.",
            3,
        ),
        (
            NAMED.format("Circle", "Node", f'"{NAME}"'),
            NAMED.format("Other", "Node", '"draw_circle"'),
            "The node name is the first argument of super().__init__.",
            3,
        ),
        (
            NAMED.format("Circle", "Node", f'"{NAME}"'),
            'print("draw_circle")\n',
            "The node name is the first argument of super().__init__.",
            3,
        ),
    ],
)
def test_what_gave_the_node_its_name_is_told(source: str, other: str, words: str, line: int) -> None:
    package = submission({NODE_FILE: source, "my_robot_controller/other.py": other})
    given = finding("node-name", evidence(SHAPES["other name"](), package))
    assert (given.cause, given.where is not None and given.where.line) == (words, line)


def test_a_module_that_imports_the_right_one_can_be_the_right_one() -> None:
    files = {NODE_FILE: "", "my_robot_controller/nodes.py": "import my_robot_controller.draw_circle\n"}
    build = replace(BUILD, entry_points={"draw_circle": "my_robot_controller.nodes:main"})
    given = finding("node-name", evidence(SHAPES["other name"](), submission(files), build=build))
    assert "the package also has a file draw_circle.py" not in given.cause


@pytest.mark.parametrize("table", ["0, " * 200_000, "-" * 100_000 + "1"])
def test_a_file_that_is_not_part_of_the_node_may_be_too_large_to_be_read(table: str) -> None:
    files = {
        NODE_FILE: None,
        "my_robot_controller/first.py": NAMED.format("Circle", "Node", f'"{NAME}"'),
        "my_robot_controller/table.py": f"TABLE = [{table}]\n",
    }
    build = replace(BUILD, entry_points={"draw_circle": "my_robot_controller.first:main"})
    given = finding("node-name", evidence(SHAPES["other name"](), submission(files), build=build))
    assert (given.diagnosis, given.cause) == ("node-name", "The node name is the first argument of super().__init__.")


@pytest.mark.parametrize(("other", "told"), [("draw_circle", True), ("draw_square", False)])
def test_the_right_node_can_be_in_another_file(other: str, *, told: bool) -> None:
    files = {
        NODE_FILE: None,
        "my_robot_controller/first.py": NAMED.format("Circle", "Node", f'"{NAME}"'),
        "my_robot_controller/second.py": NAMED.format("Other", "Node", f'"{other}"'),
    }
    build = replace(BUILD, entry_points={"draw_circle": "my_robot_controller.first:main"})
    given = finding("node-name", evidence(SHAPES["other name"](), submission(files), build=build))
    words = "The entry point draw_circle leads to first.py. The node named draw_circle is in second.py."
    assert (given.cause == words) == told
