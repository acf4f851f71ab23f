"""The reasons why package.xml cannot be read."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.tests.checks.changed import of, xml
from grader.tests.checks.made import PACKAGE_XML

if TYPE_CHECKING:
    from grader.tests.checks.changed import Files


def test_a_tag_of_a_newer_format_is_not_suggested_in_place_of_itself() -> None:
    text = 'Format 1 of package.xml has no tag <depend>. Write format="3" in the tag <package>.'
    assert of("package-xml", xml('format="3"', 'format="1"')).cause == text
    other = of("package-xml", xml("<depend>rclpy</depend>", "<quaff>rclpy</quaff>")).cause
    assert 'Write format="3" in the tag <package>.' not in other


def test_a_repeated_depend_is_enough_once() -> None:
    found = of("package-xml", xml("<depend>rclpy</depend>", "<depend>rclpy</depend>\n  <depend>rclpy</depend>")).cause
    assert "Remove one of the tags." not in found


@pytest.mark.parametrize(
    ("files", "diagnosis", "where", "cause"),
    [
        (
            {"package.xml": f"{PACKAGE_XML}<more/>"},
            "xml-malformed",
            "package.xml:15",
            '</package> on line 14 closes the first tag. No text or tag may follow it, but line 15 contains "<more/>".',
        ),
        (
            {"package.xml": f"{PACKAGE_XML}</package>\n"},
            "xml-malformed",
            "package.xml:15",
            (
                "</package> on line 14 closes the first tag. "
                'No text or tag may follow it, but line 15 contains "</package>".'
            ),
        ),
        (
            {"package.xml": f"{PACKAGE_XML.rstrip()} end\n"},
            "xml-malformed",
            "package.xml:14",
            "</package> on line 14 closes the first tag. No text or tag may follow it.",
        ),
        (
            xml("</depend>\n  <depend>turtle", "</depends>\n  <depend>turtle"),
            "xml-malformed",
            "package.xml:9",
            "<depend> on line 9 has no closing tag </depend> in the right place.",
        ),
        (
            xml("MIT", "M & T"),
            "xml-malformed",
            "package.xml:7",
            "In XML, & begins the name of a character. Write &amp; for the character & itself.",
        ),
        (
            {"package.xml": PACKAGE_XML.replace("MIT", "M\xfcT").encode("latin-1")},
            "not-utf8",
            "package.xml:7",
            "Save the file as UTF-8.",
        ),
        (
            xml("<depend>rclpy", "<depend a=1>rclpy"),
            "xml-malformed",
            "package.xml:8",
            "The value of an attribute needs quotation marks.",
        ),
        (
            xml("<depend>rclpy", '<depend a="1" a="1">rclpy'),
            "xml-malformed",
            "package.xml:8",
            "An attribute may occur only once in a tag.",
        ),
        (
            xml("MIT", "M < T"),
            "xml-malformed",
            "package.xml:7",
            "In XML, the name of a tag follows < without a space. Write &lt; for the character < itself.",
        ),
        (
            xml("MIT", "M&nbsp;T"),
            "xml-malformed",
            "package.xml:7",
            "In XML, & begins the name of a character. Write &amp; for the character & itself.",
        ),
        (
            xml("<depend>rclpy", "<!-- <depend>rclpy"),
            "xml-malformed",
            "package.xml:8",
            "A tag or a comment begins on this line, but does not end: > or --> is missing.",
        ),
        (
            {"package.xml": "name: my_robot_controller\n"},
            "xml-malformed",
            "package.xml:1",
            "An XML file begins with <?xml or with a tag, such as <package>.",
        ),
        (
            xml("</package>", ""),
            "xml-malformed",
            "package.xml:2",
            "<package> on line 2 has no closing tag </package> in the right place.",
        ),
        (
            xml("MIT", "M\x01T"),
            "xml-malformed",
            "package.xml:7",
            "",
        ),
        (
            xml("<depend>rclpy</depend>", "<run_depend>rclpy</run_depend>"),
            "package-xml-old-tag",
            "package.xml:8",
            "<run_depend> belongs to ROS 1. In format 3, use <depend> or <exec_depend>.",
        ),
        (
            xml("<depend>rclpy</depend>", "<depend>rclpy</depend>\n  <depend>rclpy</depend>"),
            "package-xml-invalid",
            "package.xml:9",
            "The package rclpy is declared more than once. One tag <depend> is enough.",
        ),
        (
            xml("<depend>rclpy</depend>", "<exec_depends>rclpy</exec_depends>"),
            "package-xml-invalid",
            "package.xml:8",
            "Format 3 of package.xml has no tag <exec_depends>. There is a tag <exec_depend>.",
        ),
        (
            xml("<depend>rclpy</depend>", "<quaff>rclpy</quaff>"),
            "package-xml-invalid",
            "package.xml:8",
            "Format 3 of package.xml has no tag <quaff>.",
        ),
    ],
)
def test_a_package_xml_that_cannot_be_read_is_explained(files: Files, diagnosis: str, where: str, cause: str) -> None:
    found = of("package-xml", files)
    assert (found.diagnosis, str(found.where), found.cause) == (diagnosis, where, cause)
