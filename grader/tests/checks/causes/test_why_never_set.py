"""A method that waits for an attribute that stays None."""

from __future__ import annotations

import pytest

from grader.checks.causes.why_never_set import never_set
from grader.tests.checks.crashes import LOOK, line_with
from grader.tests.checks.made import NODE_FILE, evidence, recording, submission

NODE = """\
class Listener(Node):
    def __init__(self):
        super().__init__("listener")
        {first}
        self.create_timer(1.0, self.report)

    def received(self, pose):
        {kept}

    def report(self):
        {guard}
        self.get_logger().info("x")
"""
FIRST, RETURN = "self.pose = None", "if self.pose is None: return"
NEVER = "self.pose is None at first, and no line gives it another value."


def said(source: str) -> tuple[str, int | None] | None:
    given = evidence(recording([]), submission({NODE_FILE: source}))
    cause = never_set(given, ("info",))
    if cause is None:
        return None
    assert cause.where is not None
    return cause.text, cause.where.line


@pytest.mark.parametrize(
    ("first", "kept", "guard", "words"),
    [
        (FIRST, "pose = pose  # look", RETURN, "assigns pose without self, so self.pose stays None."),
        (FIRST, "pose = pose  # look", "if not self.pose: return", "so self.pose stays None."),
        (f"{FIRST}  # look", "last = pose", RETURN, NEVER),
        (f"{FIRST}  # look", "pass", "if self.pose is None or self.ends: return", NEVER),
        ("self.pose: Pose = None  # look", "pass", RETURN, NEVER),
    ],
)
def test_an_attribute_that_no_line_sets_holds_the_method_back(first: str, kept: str, guard: str, words: str) -> None:
    source = NODE.format(first=first, kept=kept, guard=guard)
    found = said(source)
    assert found is not None
    assert found[0].endswith(words)
    assert found[1] == line_with(LOOK, source)


@pytest.mark.parametrize(
    ("first", "kept", "guard"),
    [
        (FIRST, "self.pose = pose", RETURN),
        (FIRST, "setattr(self, 'pose', pose)", RETURN),
        (FIRST, "other.pose = pose", RETURN),
        (FIRST, "pose = pose", "pass"),
        (FIRST, "pose = pose", "if self.pose is not None: return"),
        (FIRST, "pose = pose", "if self.pose is None and self.ends: return"),
        (FIRST, "pose = pose", "if self.pose is None: self.get_logger().info('none yet'); return"),
        ("self.pose = Pose()", "pose = pose", RETURN),
    ],
)
def test_an_attribute_that_may_be_set_or_is_not_needed_is_not_blamed(first: str, kept: str, guard: str) -> None:
    assert said(NODE.format(first=first, kept=kept, guard=guard)) is None


@pytest.mark.parametrize(
    ("test", "more", "found"),
    [
        ("self.pose is not None", "", True),
        ("self.pose and self.ends", "", True),
        ("self.pose is None", "", False),
        ("self.pose or self.ends", "", False),
        ("self.pose", "    def other(self):\n        self.get_logger().info('y')\n", False),
    ],
)
def test_the_line_may_be_inside_of_the_condition(test: str, more: str, *, found: bool) -> None:
    source = NODE.format(first=FIRST, kept="pose = pose", guard=f"if {test}:")
    source = source.replace('        self.get_logger().info("x")', '            self.get_logger().info("x")')
    assert (said(source + more) is not None) == found
