"""The causes of an AttributeError of a function or a method."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import reported

SOURCE = """\
class Driver(Node):
    def pose(self, message):
        {stored}

    def send(self):
        print({read})  # crashed
"""


@pytest.mark.parametrize(
    ("stored", "read", "found"),
    [
        ("self.pose = message", "self.pose.x", True),
        ("self.place = message", "self.pose.x", False),
        ("self.pose = message", "self.send.x", False),
    ],
)
def test_an_attribute_with_the_name_of_a_method_is_told(stored: str, read: str, *, found: bool) -> None:
    given = reported(SOURCE.format(stored=stored, read=read), "AttributeError: 'method' object has no attribute 'x'")
    assert (given.diagnosis, given.line) == (("name-used-twice", 3) if found else ("not-called", 6))
    words = "self.pose is still the method pose: line 3, which assigns self.pose, has not run yet. Use two names."
    assert (given.cause == words) == found


@pytest.mark.parametrize(("outer", "found"), [("def send(self):", True), ("if True:", False)])
def test_only_a_method_inside_a_method_is_called_indented_too_far(outer: str, *, found: bool) -> None:
    inner = "        def __call__(self):\n            pass\n"
    source = f"class Driver(Node):\n    {outer}\n{inner}\nDriver()()  # crashed\n"
    given = reported(source, "TypeError: 'Driver' object is not callable")
    assert given.diagnosis == ("method-in-method" if found else "not-callable")


@pytest.mark.parametrize(("line", "found"), [("self.speed: float = 1.0", True), ("self.speed: float", False)])
def test_an_annotation_alone_assigns_nothing(line: str, *, found: bool) -> None:
    source = f"class Driver(Node):\n    def send(self):\n        {line}\n\n    def stop(self):\n"
    source += "        self.speed()  # crashed\n"
    given = reported(source, "AttributeError: 'Driver' object has no attribute 'speed'")
    assert ("self.speed is assigned on line 3, which has not run yet." in given.cause) == found
