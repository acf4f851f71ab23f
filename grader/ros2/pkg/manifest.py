"""The verb `pkg xml`: print the manifest of a package (package.xml), or one of its tags."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from grader.ros import index
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros2 import unsourced
from grader.ros2.completion import completes, packages

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    completes(parser.add_argument("package_name", help="name of the package"), packages)
    parser.add_argument("-t", "--tag", help="print only the text of this tag, for example version")


def run(args: argparse.Namespace) -> int:
    """Print the manifest or the tag.

    Raises:
        Ros2Error: the package or the tag does not exist, or the manifest cannot be read.
    """
    from xml.etree import ElementTree as ET

    unsourced.find(args.package_name, "Package not found")
    file = index.prefix_of(args.package_name, "Package not found") / "share" / args.package_name / "package.xml"
    if not file.is_file():
        message = "Package XML manifest not found"
        raise Ros2Error(message)
    try:
        tree = ET.parse(file)
    except (ET.ParseError, OSError) as error:
        message = f"{file} cannot be read: {error}"
        raise Ros2Error(message) from error
    if args.tag is None:
        sys.stdout.write(ET.tostring(tree.getroot(), encoding="unicode").rstrip("\n") + "\n")
        return 0
    found = tree.getroot().findall(args.tag)
    if not found:
        tags = {element.tag for element in tree.getroot()}
        raise Ros2Error(did_you_mean(args.tag, tags, "XML tag not found"))
    for element in found:
        print(element.text)
    return 0
