"""Tests of edits: where an edit applies, and what it leaves unchanged."""

from __future__ import annotations

import pytest

from grader.checks.edit import Edit, applied, at, difference
from grader.submission.where import Where

FILE = "my_robot_controller/node.py"
SOURCE = b"import rclpy\n\ncounter = self.counter + counts\n"


@pytest.mark.parametrize(
    ("edit", "line"),
    [
        (Edit(FILE, 3, "counts", "self.counts"), "counter = self.counter + self.counts"),
        (Edit(FILE, 3, "counter", "total"), "total = self.counter + counts"),
        (Edit(FILE, 3, " + ", " - "), "counter = self.counter - counts"),
        (Edit(FILE, 3, "", "x = 1"), "x = 1"),
    ],
)
def test_an_edit_changes_its_line(edit: Edit, line: str) -> None:
    changed = applied({FILE: SOURCE}, [edit])
    assert changed is not None
    assert changed[FILE].decode().splitlines()[2] == line


@pytest.mark.parametrize("edit", [Edit(FILE, 3, "speed", "x"), Edit(FILE, 30, "x", "y"), Edit("no.py", 3, "x", "y")])
def test_an_edit_that_does_not_fit_changes_nothing(edit: Edit) -> None:
    assert applied({FILE: SOURCE}, [edit]) is None


def test_a_new_line_does_not_move_the_lines_of_the_other_edits() -> None:
    changed = applied({FILE: SOURCE}, [Edit(FILE, 1, "", "import math"), Edit(FILE, 3, "counts", "2")])
    assert changed == {FILE: b"import math\nimport rclpy\n\ncounter = self.counter + 2\n"}


def test_bytes_that_are_not_utf8_stay_as_they_are() -> None:
    changed = applied({FILE: b"\xff = 1\n"}, [Edit(FILE, 1, "1", "2")])
    assert changed == {FILE: b"\xff = 2\n"}


def test_the_difference_shows_only_what_changed() -> None:
    changed = applied({FILE: SOURCE}, [Edit(FILE, 3, "counts", "2")])
    assert changed is not None
    lines = difference({FILE: SOURCE}, changed).splitlines()
    assert lines[-2:] == ["-counter = self.counter + counts", "+counter = self.counter + 2"]


def test_a_place_without_a_line_has_no_edit() -> None:
    assert (at(None, "a", "b"), at(Where(FILE), "a", "b")) == ((), ())
    assert at(Where(FILE, 2), "a", "b") == (Edit(FILE, 2, "a", "b"),)
