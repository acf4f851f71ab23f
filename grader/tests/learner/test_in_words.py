"""The sentence that says how a learner's file differs from the solution."""

from __future__ import annotations

import pytest

from grader.learner.in_words import difference

OURS = '''"""Ours."""

SPEED = 2.0


class Node:
    def __init__(self):
        self.speed = SPEED

    def step(self):
        return self.speed
'''

REST = "The code is the same in __init__ and the lines outside functions."


@pytest.mark.parametrize(
    ("theirs", "said"),
    [
        (OURS.replace("Ours", "Mine"), "The code is the same. Only comments, docstrings or the layout differ."),
        (
            OURS.replace("return self.speed", "return 2 * self.speed"),
            f"{REST} The code is different in step.",
        ),
        (
            OURS.replace("def step", "def go"),
            f"{REST} Only your file has go. Only the solution has step.",
        ),
        (
            OURS.replace("class Node:", "class Node(Base):"),
            "The code is the same in __init__ and step. The code is different in the lines outside functions.",
        ),
        ("", "Your work does not contain this file, or the file is empty or not UTF-8."),
    ],
)
def test_each_difference_has_its_sentence(theirs: str, said: str) -> None:
    assert difference(theirs, OURS, "node.py") == said


def test_methods_of_the_same_name_in_two_classes_are_all_compared() -> None:
    second = OURS + "\n\nclass Other:\n    def step(self):\n        return 1\n"
    theirs = second.replace("return self.speed", "return 0")
    assert "The code is different in step." in difference(theirs, second, "node.py")


def test_other_files_are_compared_by_their_lines() -> None:
    assert difference("a\nb\n", "a\nc\n", "setup.cfg") == "1 line differs."
    assert difference("a\nb\n", "a\nc\nd\n", "setup.cfg") == "2 lines differ."
    assert difference("a\nb\na\n", "a\na\nb\n", "package.xml") == "2 lines differ."
    assert difference("a\nb", "a\nb\n", "setup.cfg") == "Only line breaks differ."
