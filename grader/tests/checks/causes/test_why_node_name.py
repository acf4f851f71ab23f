"""The reasons why a node has another name. More of them are in grader/tests/checks/subjects/test_node_name.py."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_node_name import why_node_name
from grader.tests.checks.made import NODE_FILE, evidence, submission

INIT = "class Driver(Node):\n    def __init__(self):\n        "


@pytest.mark.parametrize(
    ("source", "argument", "line"),
    [
        ('import rclpy\nnode = rclpy.create_node("x")\n', "first argument of create_node", 2),
        ('from rclpy.node import Node\n\nnode = Node("x")\n', "first argument of Node", 3),
        (
            'class Driver(Node):\n    def __init__(self):\n        super().__init__("x")\n',
            "first argument of super().__init__",
            3,
        ),
        (f"{INIT}Node.__init__(self, 'x')\n", "second argument of Node.__init__, after self", 3),
        (f"{INIT}Node.__init__(self, node_name='x')\n", "argument node_name of Node.__init__", 3),
        (f"{INIT}super().__init__(namespace='', node_name='x')\n", "argument node_name of super().__init__", 3),
        (f"{INIT}super(Driver, self).__init__('x')\n", "first argument of super().__init__", 3),
        ("rclpy.init()\n", "first argument of super().__init__", None),
    ],
)
def test_the_function_that_gets_the_name_is_told(source: str, argument: str, line: int | None) -> None:
    cause = why_node_name(evidence(package=submission({NODE_FILE: source})), "x")
    place = None if cause.where is None else cause.where.line
    assert (cause.text, place) == (f"The node name is the {argument}.", line)


def test_a_name_after_self_is_found_even_if_another_node_is_first() -> None:
    source = f"{INIT}Node.__init__(self, 'x')\n\nother = rclpy.create_node('y')\n"
    cause = why_node_name(evidence(package=submission({NODE_FILE: source})), "x")
    assert cause.text == "The node name is the second argument of Node.__init__, after self."
