"""An attribute that every node has, and a method of nodes that an object does not have."""

from __future__ import annotations

import pytest

from grader.tests.checks.crashes import DRIVER, reported, to_look_at

NO_SETTER = "AttributeError: property '{}' of '{}' object has no setter"
PROPERTY = "    @property\n    def speed(self):  # look\n        return self.count\n"


@pytest.mark.parametrize(
    ("line", "error", "name"),
    [
        ("self.timers = []", NO_SETTER.format("timers", "Driver"), "timers"),
        ("self.timers = []", "AttributeError: can't set attribute 'timers'", "timers"),
        ("self.handle = 3", "AttributeError: handle cannot be modified after node creation", "handle"),
        ("now.nanoseconds = 3", NO_SETTER.format("nanoseconds", "Time"), None),
    ],
)
def test_an_attribute_that_every_node_has_is_named(line: str, error: str, name: str | None) -> None:
    given = reported(DRIVER.format(line=line), error)
    words = f"Every node already has an attribute named {name}. Choose another name."
    assert (given.cause == words) == (name is not None)
    assert "Every node already has" not in reported(DRIVER.format(line=line), "AttributeError: nothing known").cause


def test_a_property_of_the_students_own_is_not_one_of_every_node() -> None:
    source = DRIVER.format(line="self.speed = 3").replace("\ndef outside", f"\n{PROPERTY}\ndef outside")
    given = reported(source, NO_SETTER.format("speed", "Driver"))
    assert (given.diagnosis, given.line) == ("name-used-twice", to_look_at(source))
    assert given.cause.startswith("speed is a property without a setter, so it cannot be assigned.")
    assert "Every node already has" not in given.cause


@pytest.mark.parametrize(
    ("base", "name", "words"),
    [
        (
            "",
            "create_timer",
            "Driver is not derived from Node, so it has no method create_timer.",
        ),
        (
            "(object)",
            "get_logger",
            "Driver is not derived from Node, so it has no method get_logger.",
        ),
        ("", "create_timr", "A similar name exists: create_timer."),
        ("(Thread)", "create_timer", "Driver is not derived from Node, so it has no method create_timer."),
    ],
)
def test_a_class_that_is_not_derived_from_node_has_none_of_its_methods(base: str, name: str, words: str) -> None:
    source = DRIVER.format(line=f"self.{name}()").replace("(Node)", base)
    given = reported(source, f"AttributeError: 'Driver' object has no attribute '{name}'")
    assert given.cause.startswith(words)
    assert (given.line == 3) == ("is not derived from" in words)


TWO_TIMERS = """\
class Driver(Node):
    def __init__(self):
        self.timer = None
        self.timer = self.create_timer(0.5, self.send)
        timer = self.create_timer(1.0, self.send)
        timer.cancel()

    def send(self):
        timer = self.timer
        {line}
"""


@pytest.mark.parametrize(
    ("source", "more"),
    [
        (TWO_TIMERS.format(line="self.timer.stop()  # crashed"), ""),
        (TWO_TIMERS.format(line="timer.stop()  # crashed"), ""),
        (
            TWO_TIMERS.format(line="self.timer.stop()  # crashed").replace("None", "self.create_timer(2.0, self.send)"),
            " self.timer is assigned on lines 3 and 4. Use one name per object.",
        ),
        (
            TWO_TIMERS.format(line="timer = self.timer\n        timer.stop()  # crashed"),
            " timer is assigned on lines 9 and 10. Use one name per object.",
        ),
    ],
)
def test_only_assignments_of_the_same_variable_are_named(source: str, more: str) -> None:
    given = reported(source, "AttributeError: 'Timer' object has no attribute 'stop'")
    assert given.cause == f"Timer objects have no attribute or method with that name.{more}"


@pytest.mark.parametrize(
    ("made", "line", "diagnosis"),
    [
        ("self.sub = self.create_subscription(Twist, 'a', print, 10)", "self.pub.publish(msg)", "attribute-missing"),
        ("self.sub = self.create_publisher(Twist, 'a', 10)", "self.pub.publish(msg)", "attribute-misspelt"),
        ("self.speed = 1\n    def pubs(self):\n        pass", "self.pub.publish(msg)", "attribute-missing"),
        ("self.speed = 1\n    def pubs(self):\n        pass", "self.pub()", "attribute-misspelt"),
        ("self.sub = self.create_subscription(Twist, 'a', print, 10)", "print(self.pub)", "attribute-misspelt"),
    ],
)
def test_a_subscription_is_not_suggested_for_a_publisher(made: str, line: str, diagnosis: str) -> None:
    start = f"class Driver(Node):\n    def __init__(self):\n        {made}\n"
    source = f"{start}    def send(self):\n        {line}  # crashed\n"
    given = reported(source, "AttributeError: 'Driver' object has no attribute 'pub'")
    assert given.diagnosis == diagnosis, given.cause
