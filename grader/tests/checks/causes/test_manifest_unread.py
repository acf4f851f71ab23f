"""The reasons why package.xml cannot be read."""

from __future__ import annotations

from grader.tests.checks.changed import of, xml


def test_a_tag_of_a_newer_format_is_not_suggested_in_place_of_itself() -> None:
    text = 'Format 1 of package.xml has no tag <depend>. Write format="3" in the tag <package>.'
    assert of("package-xml", xml('format="3"', 'format="1"')).cause == text
    other = of("package-xml", xml("<depend>rclpy</depend>", "<quaff>rclpy</quaff>")).cause
    assert 'Write format="3" in the tag <package>.' not in other


def test_a_repeated_depend_is_enough_once() -> None:
    found = of("package-xml", xml("<depend>rclpy</depend>", "<depend>rclpy</depend>\n  <depend>rclpy</depend>")).cause
    assert "Remove one of the tags." not in found
