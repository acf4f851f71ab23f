from __future__ import annotations

import pytest

from grader.errors import UsageError
from grader.exercise.markers import ANGLE, HASH, solved, stripped, syntax_of

PYTHON = """\
def send(self):
    # BEGIN SOLUTION
    self.publisher.publish(Twist())
    # END SOLUTION
    # BEGIN STARTER
    # # TODO: publish.
    #
    # if True:
    #     pass
    # END STARTER

"""
XML = """\
<package>
  <!-- BEGIN SOLUTION -->
  <depend>rclpy</depend>
  <!-- END SOLUTION -->
  <!-- BEGIN STARTER
  <! TODO: what does the node import? !>
  <depend></depend>
  END STARTER -->
</package>
"""


def test_a_starter_block_stands_where_the_solution_was() -> None:
    wanted = "def send(self):\n    # TODO: publish.\n\n    if True:\n        pass\n\n"
    assert stripped(PYTHON, HASH, "x.py") == wanted


def test_in_xml_a_starter_block_is_one_comment() -> None:
    wanted = "<package>\n  <!-- TODO: what does the node import? -->\n  <depend></depend>\n</package>\n"
    assert stripped(XML, ANGLE, "package.xml") == wanted


def test_a_region_without_a_starter_block_goes() -> None:
    assert stripped("a = 1\n# BEGIN SOLUTION\nb = 2\n# END SOLUTION\nc = 3\n", HASH, "x.py") == "a = 1\nc = 3\n"


def test_the_solution_without_a_trace_of_markers() -> None:
    assert solved(PYTHON, HASH, "x.py") == "def send(self):\n    self.publisher.publish(Twist())\n\n"
    assert solved(XML, ANGLE, "x.xml") == "<package>\n  <depend>rclpy</depend>\n</package>\n"


def test_blank_lines_may_stand_between_the_blocks() -> None:
    text = "# BEGIN SOLUTION\na\n# END SOLUTION\n\n# BEGIN STARTER\n# b\n# END STARTER\n"
    assert stripped(text, HASH, "x.py") == "b\n"


def test_notebooks_write_three_signs_and_perhaps_no_last_line_end() -> None:
    assert stripped("### BEGIN SOLUTION\r\na\r\n### END SOLUTION", HASH, "x.py") == ""


def test_a_text_without_markers_stays_as_it_is() -> None:
    text = "a\r\n\n\tb  \n# the solution begins here"
    assert stripped(text, HASH, "x.py") == text == solved(text, HASH, "x.py")


@pytest.mark.parametrize(
    ("text", "line", "what"),
    [
        ("a\n# BEGIN SOLUTION\nb\n", 2, "BEGIN SOLUTION has no END SOLUTION"),
        ("# BEGIN SOLUTION\n# END SOLUTION\n# BEGIN STARTER\n# a\n", 3, "BEGIN STARTER has no END STARTER"),
        ("a\n# END SOLUTION\n", 2, "END SOLUTION without a BEGIN SOLUTION"),
        ("# END STARTER\n", 1, "END STARTER without a BEGIN STARTER"),
        ("# BEGIN SOLUTION\n# BEGIN SOLUTION\n", 2, "BEGIN SOLUTION inside the SOLUTION block that begins on line 1"),
        ("# BEGIN SOLUTION\n# BEGIN STARTER\n", 2, "BEGIN STARTER inside the SOLUTION block"),
        ("# BEGIN SOLUTION\n# END STARTER\n", 2, "END STARTER without a BEGIN STARTER"),
        ("# BEGIN STARTER\n# a\n# END STARTER\n", 1, "right below an END SOLUTION"),
        ("# BEGIN SOLUTION\n# END SOLUTION\na\n# BEGIN STARTER\n", 4, "right below an END SOLUTION"),
        ("# BEGIN SOLUTION\n# END SOLUTION\n# BEGIN STARTER\na\n", 4, "must begin with '#'"),
        ("# BEGIN SOLUTION\n# END SOLUTION\n# BEGIN STARTER\na # b\n", 4, "must begin with '#'"),
        ("a\n# Begin Solution\n", 2, "looks like a marker"),
        ("a = 1  # BEGIN SOLUTION\n", 1, "looks like a marker"),
        ("# BEGIN SOLUTION:\n", 1, "looks like a marker"),
        ("<!-- BEGIN SOLUTION -->\n", 1, "looks like a marker"),
    ],
)
def test_wrong_markers_are_reported_with_their_line(text: str, line: int, what: str) -> None:
    with pytest.raises(UsageError) as caught:
        stripped(text, HASH, "step/x.py")
    assert str(caught.value).startswith(f"step/x.py:{line}: ")
    assert what in str(caught.value)


@pytest.mark.parametrize("path", ["a/b.py", "answers.toml", "setup.cfg"])
def test_hash_comments(path: str) -> None:
    assert syntax_of(path) is HASH


@pytest.mark.parametrize("path", ["package.xml", "a.b/README.md"])
def test_angle_comments(path: str) -> None:
    assert syntax_of(path) is ANGLE


@pytest.mark.parametrize("path", ["resource/my_robot_controller", "circle.png", "a.py/b"])
def test_other_files_have_no_comments_that_we_know(path: str) -> None:
    assert syntax_of(path) is None
