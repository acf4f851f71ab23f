"""Mistakes in package.xml."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.tests.operators.operator import (
    Change,
    Make,
    Operator,
    Package,
    edited,
    line_at,
    misspelt,
    remove_line,
    replace,
)

if TYPE_CHECKING:
    from random import Random

    from grader.checks.diagnosis import Diagnosis

FILE = "package.xml"
DEPEND = r"<(?P<tag>(?:exec_)?depend)>(?P<name>rclpy|geometry_msgs|turtlesim)</(?P=tag)>"


def _in_xml(name: str, pattern: str, by: str, *says: Diagnosis, also: tuple[Diagnosis, ...] = ()) -> Operator:
    return Operator(name, replace(pattern, by, file=FILE), frozenset(says), also=frozenset(also))


def _misspelt_dependency(package: Package, draw: Random) -> Change | None:
    make: Make = replace(DEPEND, lambda m: m[0].replace(m["name"], misspelt(m["name"], draw)), file=FILE)
    return make(package, draw)


def _tag_not_closed(package: Package, draw: Random) -> Change | None:
    text = package.files.get(FILE, "")
    tags = list(re.finditer(r"</(name|version|description|depend|license|build_type|export)>", text))
    if not tags:
        return None
    tag = draw.choice(tags)
    opened = line_at(text, text.rindex(f"<{tag[1]}", 0, tag.start()))
    return edited(package, FILE, text[: tag.start()] + text[tag.end() :], opened, line_at(text, tag.start()))


def _text_after_the_end(package: Package, draw: Random) -> Change | None:
    text = package.files.get(FILE)
    if text is None:
        return None
    new = text.rstrip("\n") + "\n" + draw.choice(["<depend>rclpy</depend>", "end", "</package>"]) + "\n"
    return edited(package, FILE, new, line_at(new, len(new) - 2))


OPERATORS = (
    Operator("dependency-left-out", remove_line(DEPEND, file=FILE), frozenset({"missing-depend"})),
    Operator("dependency-misspelt", _misspelt_dependency, frozenset({"depend-misspelt"})),
    _in_xml("dependency-in-a-comment", DEPEND, r"<!-- \g<0> -->", "depend-commented-out"),
    _in_xml("dependency-for-building", DEPEND, r"<build_depend>\g<name></build_depend>", "depend-kind"),
    Operator("build-type-left-out", remove_line(r"<build_type>.*</build_type>", file=FILE), frozenset({"build-type"})),
    _in_xml("build-type-cmake", r"ament_python", "ament_cmake", "build-type"),
    _in_xml("other-name", r"<name>.*</name>", "<name>robot_controller</name>", "package-name", also=("setup-cfg",)),
    _in_xml(
        "name-with-dashes", r"<name>.*</name>", "<name>my-robot-controller</name>", "package-name", also=("setup-cfg",)
    ),
    Operator("no-license", remove_line(r"<license>.*</license>", file=FILE), frozenset({"package-xml-invalid"})),
    Operator(
        "no-maintainer", remove_line(r"<maintainer.*</maintainer>", file=FILE), frozenset({"package-xml-invalid"})
    ),
    _in_xml("old-tag", DEPEND, r"<run_depend>\g<name></run_depend>", "package-xml-old-tag"),
    _in_xml(
        "catkin", r"<export>(?:.|\n)*</export>", "<buildtool_depend>catkin</buildtool_depend>", "ros-1-package-xml"
    ),
    _in_xml("slash-left-out", r"</(depend|license|name)>", r"<\1>", "xml-malformed"),
    Operator("tag-not-closed", _tag_not_closed, frozenset({"xml-malformed"})),
    Operator("text-after-the-end", _text_after_the_end, frozenset({"xml-malformed"})),
)
