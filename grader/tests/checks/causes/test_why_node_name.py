"""The reasons why a node has another name. More of them are in grader/tests/checks/subjects/test_node_name.py."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_node_name import why_node_name
from grader.tests.checks.made import NODE_FILE, evidence, submission


@pytest.mark.parametrize(
    ("source", "function", "line"),
    [
        ('import rclpy\nnode = rclpy.create_node("x")\n', "create_node", 2),
        ('from rclpy.node import Node\n\nnode = Node("x")\n', "Node", 3),
        ('class Driver(Node):\n    def __init__(self):\n        super().__init__("x")\n', "super().__init__", 3),
        ('class Driver(Node):\n    def __init__(self):\n        Node.__init__(self, "x")\n', "super().__init__", 3),
        ("rclpy.init()\n", "super().__init__", None),
    ],
)
def test_the_function_that_gets_the_name_is_told(source: str, function: str, line: int | None) -> None:
    cause = why_node_name(evidence(package=submission({NODE_FILE: source})), "x")
    place = None if cause.where is None else cause.where.line
    assert (cause.text, place) == (f"The node name is the first argument of {function}.", line)
