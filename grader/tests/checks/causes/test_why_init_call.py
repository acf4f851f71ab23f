"""Mistakes in the call that creates a node: super().__init__, Node.__init__, Node, or the class statement."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import CRASHED, LOOK, reported, to_look_at

SOURCE = """\
from rclpy.node import Node

class Driver(Node):
    def __init__(self):
        {line}  # crashed
"""
NO_NAME = "TypeError: Node.__init__() missing 1 required positional argument: 'node_name'"
MANY = "TypeError: Node.__init__() takes 2 positional arguments but 3 were given"


@pytest.mark.parametrize(
    ("line", "error", "diagnosis", "cause"),
    [
        (
            "super().__init__()",
            NO_NAME,
            "node-name-missing",
            "Pass the node name, a string, to super().__init__.",
        ),
        (
            'Node.__init__("driver")',
            NO_NAME,
            "node-name-missing",
            "Pass self and then the node name, a string, to Node.__init__.",
        ),
        ("node = Node()", NO_NAME, "node-name-missing", "Pass the node name, a string, to Node."),
        (
            'super().__init__(self, "driver")',
            MANY,
            "too-many-arguments",
            "super() already passes self. Leave out self in the parentheses.",
        ),
        (
            'super().__init__("driver", 10)',
            MANY,
            "too-many-arguments",
            "Pass only the node name to super().__init__, or write names such as namespace= before the others.",
        ),
        (
            'super().__init__(name="driver")',
            "TypeError: Node.__init__() got an unexpected keyword argument 'name'",
            "unexpected-keyword",
            "Node has no parameter name. Pass the node name as the first argument, without a name and =.",
        ),
        (
            "super().__init__(42)",
            "TypeError: __init__(): incompatible constructor arguments",
            "crash",
            "The node name must be a string in quotation marks, or a variable with a string.",
        ),
        (
            'super()._init_("driver")',
            "AttributeError: 'super' object has no attribute '_init_'",
            "attribute-misspelt",
            "The method is named __init__, with two underscores on each side: super().__init__.",
        ),
    ],
)
def test_a_wrong_call_of_init_is_explained(line: str, error: str, diagnosis: str, cause: str) -> None:
    found = reported(SOURCE.format(line=line), error)
    assert (found.diagnosis, found.cause) == (diagnosis, cause)


def test_a_node_without_its_base_class_is_told() -> None:
    source = "class Driver:  # look\n    def __init__(self):\n        super().__init__('driver')  # crashed\n"
    error = "TypeError: object.__init__() takes exactly one argument (the instance to initialize)"
    found = reported(source, error)
    text = "Driver has no base class. A node needs the base class Node: class Driver(Node)."
    assert (found.cause, found.line) == (text, to_look_at(source))
    assert "has no base class" not in reported(source.replace("Driver:", "Driver(A):"), error).cause


def test_a_module_is_not_a_base_class() -> None:
    found = reported(f"import rclpy\nclass Driver(rclpy.node):  {CRASHED}\n    pass\n", MODULE)
    text = "rclpy.node is a module, not a class. The class of a node is Node, in the module rclpy.node."
    assert (found.diagnosis, found.cause) == ("import-wrong-place", text)


MODULE = "TypeError: module() takes at most 2 arguments (3 given)"


@pytest.mark.parametrize(("line", "told"), [("super().__init__", True), ("pass", False)])
def test_init_without_parentheses_is_not_a_call(line: str, *, told: bool) -> None:
    source = f"class Driver(Node):\n    def __init__(self):\n        {line}  {LOOK}\n"
    source += f"        self.create_timer()  {CRASHED}\n"
    found = reported(source, "AttributeError: 'Driver' object has no attribute '_default_callback_group'")
    text = "super().__init__ is not called. Write parentheses after it, with the node name inside."
    assert found.diagnosis == "super-init-missing"
    assert (found.cause == text) == told


@pytest.mark.parametrize(("base", "told"), [("node", True), ("knot", False)])
def test_a_base_class_in_small_letters_is_told(base: str, *, told: bool) -> None:
    source = (
        f"from rclpy.node import Node\nclass Driver({base}):  {CRASHED}\n    pass\n\ndef main():\n    node = Driver()\n"
    )
    found = reported(source, f"NameError: name '{base}' is not defined")
    assert (found.cause == "A similar name exists: Node. Upper and lower case matter.") == told


@pytest.mark.parametrize(
    ("methods", "diagnosis"),
    [
        ("    def _init_(self):  # look\n        self.way = 0.0\n", "init-misspelt"),
        ("    def init(self):  # look\n        self.way = 0.0\n", "init-misspelt"),
        (
            "    def _init_(self):  # look\n        self.way = 0.0\n    def reset(self):\n        self.way = 0.0\n",
            "init-misspelt",
        ),
        ("    def __init__(self):\n        pass\n    def init(self):\n        self.way = 0.0\n", "attribute-too-early"),
        ("    def _init_(self):\n        pass\n    def reset(self):\n        self.way = 0.0\n", "attribute-too-early"),
    ],
)
def test_a_misspelt_init_never_assigns_the_attributes_of_a_class(methods: str, diagnosis: str) -> None:
    source = f"class Odometer:\n{methods}    def tell(self):\n        return self.way  # crashed\n"
    found = reported(source, "AttributeError: 'Odometer' object has no attribute 'way'")
    assert (found.diagnosis, found.line) == (diagnosis, to_look_at(source))
