"""Manifest: the content of a package.xml, read with catkin_pkg, as colcon does."""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import dataclass
from xml.parsers.expat import ExpatError, ParserCreate

from grader.common.lazy import catkin_package
from grader.common.words import shorten

MAX_BYTES = 200_000
AT_LINE = re.compile(r"line (\d+), column \d+")
NO_NEWS = re.compile(r"Error\(s\) in package '[^']*':|Error\(s\):|The manifest contains invalid XML:")


@dataclass(frozen=True)
class Manifest:
    """A package.xml.

    `run_depends` are the run-time dependencies. `other_depends` are dependencies only for building or testing.

    `problem` is the reason why the file is invalid, and `line` the line of the error, if known. If there is a
    `problem`, the fields above it are empty.
    """

    name: str = ""
    build_type: str | None = None
    run_depends: tuple[str, ...] = ()
    other_depends: tuple[str, ...] = ()
    problem: str | None = None
    line: int | None = None


def read_manifest(data: bytes) -> Manifest:
    """Read a package.xml. An error is stored in `problem` and never raised."""
    if len(data) > MAX_BYTES:
        return Manifest(problem=f"it is larger than {MAX_BYTES // 1000} kB")
    warnings: list[str] = []
    try:
        package = catkin_package.parse_package_string(data, "package.xml", warnings)
    except Exception as error:  # InvalidPackage, or any other exception that a broken file causes
        text = str(error)
        at = AT_LINE.search(text)
        problem = shorten(NO_NEWS.sub(" ", text).strip(" \n-"), 160)
        return Manifest(problem=problem, line=int(at[1]) if at else None)
    running = {each.name for each in package.exec_depends}
    every = [*package.build_depends, *package.buildtool_depends, *package.build_export_depends, *package.test_depends]
    return Manifest(
        name=package.name,
        build_type=next((each.content for each in package.exports if each.tagname == "build_type"), None),
        run_depends=tuple(sorted(running)),
        other_depends=tuple(sorted({each.name for each in every} - running)),
    )


def open_tag(data: bytes) -> tuple[str, int]:
    """Return the innermost tag that is open at the first XML error, and the tag's line, or ("", 1) if none is open."""
    parser = ParserCreate()
    opened: list[tuple[str, int]] = []
    parser.StartElementHandler = lambda name, _: opened.append((name, parser.CurrentLineNumber))
    parser.EndElementHandler = lambda _: opened.pop()
    with suppress(ExpatError):
        parser.Parse(data, True)  # noqa: FBT003 (the argument means that no more data follows)
    return opened[-1] if opened else ("", 1)


def end_of_root(data: bytes) -> tuple[str, int] | None:
    """Return the name of the first root tag and the line on which this tag is closed, or None."""
    parser = ParserCreate()
    depth = [0]
    ends: list[tuple[str, int]] = []

    def ended(name: str) -> None:
        depth[0] -= 1
        if depth[0] == 0:
            ends.append((name, parser.CurrentLineNumber))

    def started(_name: str, _attributes: object) -> None:
        depth[0] += 1

    parser.StartElementHandler, parser.EndElementHandler = started, ended
    with suppress(ExpatError):
        parser.Parse(data, True)  # noqa: FBT003 (the argument means that no more data follows)
    return ends[0] if ends else None


def line_of(data: bytes, *patterns: str) -> int | None:
    """Return the first line (from 1) that matches a pattern, or None.

    A line that matches an earlier pattern takes precedence over a line that matches a later pattern.
    """
    lines = data.decode("utf-8", "replace").splitlines()
    for pattern in patterns:
        for number, line in enumerate(lines, start=1):
            if re.search(pattern, line):
                return number
    return None
