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


@pytest.mark.parametrize(
    ("old", "new", "line", "cause"),
    [
        (
            "<name>my_robot_controller",
            "<name>My Robot",
            3,
            "A package name has only small letters, digits and underscores. It begins with a letter.",
        ),
        ("0.1.0", "0.1", 4, "A version is three numbers with dots between them, such as 0.1.0."),
        (
            "student@example.com",
            "student",
            6,
            "An email address has the form NAME@DOMAIN, such as student@example.com.",
        ),
        (
            ' email="student@example.com"',
            "",
            6,
            'Write the email address in the first tag: <maintainer email="NAME@DOMAIN">.',
        ),
        ('format="3"', 'format="4"', 2, 'Write format="3" in the tag <package>.'),
        ("MIT", "", 7, "Write the name of the license between <license> and </license>."),
        ("<?xml ", "\n<?xml ", 2, "The first line must begin with <?xml. Remove the spaces and lines before it."),
        ("<depend>rclpy", "<depend rclpy", 8, "A tag on this line does not end: > is missing before the next <."),
        ("rclpy</depend>", "rclpy</depend", 8, "The last tag on line 8 does not end: > is missing."),
        ("<depend>rclpy", "<!-- a -- b --><depend>rclpy", 8, "A comment cannot contain two hyphens in a row."),
    ],
)
def test_a_broken_rule_is_explained_on_its_line(old: str, new: str, line: int, cause: str) -> None:
    found = of("package-xml", xml(old, new))
    assert (found.cause, found.where is not None and found.where.line) == (cause, line)
