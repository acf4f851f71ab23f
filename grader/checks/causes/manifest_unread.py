"""Explain why catkin_pkg, and therefore colcon, cannot read package.xml."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.syntax import UTF_16
from grader.common.words import nearest, shorten
from grader.submission.package_xml import end_of_root, line_of, open_tag
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.submission.package_xml import Manifest

FILE = "package.xml"
XML = re.compile(
    r"mismatched tag|not well-formed|no element found|junk after|unclosed|duplicate attribute|invalid XML|syntax error"
    r"|invalid token|undefined entity"
)
"""Matches the messages of an XML parser about text that is not well-formed."""
AMPERSAND = "In XML, & begins the name of a character. Write &amp; for the character & itself."
MISTAKES = (
    ("undefined entity", r"", AMPERSAND),
    ("duplicate attribute", r"", "An attribute may occur only once in a tag."),
    ("unclosed", r"", "A tag or a comment begins on this line, but does not end: > or --> is missing."),
    ("no element|syntax error", r"", "An XML file begins with <?xml or with a tag, such as <package>."),
    ("", r"&(?!#?\w+;)", AMPERSAND),
    (
        "",
        r"<(?![\w/!?])",
        "In XML, the name of a tag follows < without a space. Write &lt; for the character < itself.",
    ),
    ("", r"<[^>]*\s[\w:]+=(?![\"'\s])", "The value of an attribute needs quotation marks."),
    ("", r"<!--.*--.*-->", "A comment cannot contain two hyphens in a row."),
    ("", r"</?\w[^<>]*<", "A tag on this line does not end: > is missing before the next <."),
)
"""Tuples (pattern of the problem, pattern of the line, cause). The first pair of patterns that match is used."""
UNKNOWN_TAG = re.compile(
    r"\(with format version (?P<format>\d)\) must not contain the following tags: (?P<tag>[^\s,]{1,60})"
)
TAGS = (
    *("name", "version", "description", "maintainer", "license", "url", "author", "export"),
    *("depend", "exec_depend", "build_depend", "build_export_depend", "buildtool_depend", "test_depend"),
)
"""The tags that the grader suggests in place of an unknown tag."""
RULES = (
    (
        "naming conventions",
        "name",
        "A package name has only small letters, digits and underscores. It begins with a letter.",
    ),
    ("version conventions", "version", "A version is three numbers with dots between them, such as 0.1.0."),
    ("Invalid email", "maintainer", "An email address has the form NAME@DOMAIN, such as student@example.com."),
    ('attribute "email"', "maintainer", 'Write the email address in the first tag: <maintainer email="NAME@DOMAIN">.'),
    ("package.xml format version", "package", 'Write format="3" in the tag <package>.'),
    ("neither be empty", "license", "Write the name of the license between <license> and </license>."),
)
"""Tuples (pattern of the problem, tag whose line must change, cause)."""
TWICE = re.compile(r"dependency on ['\"](?P<name>[^'\"]{1,100})['\"] is redundant")
ROS_1_TAGS = re.compile(r"must not contain the following tags: .*\b(?P<tag>run_depend)\b")


def why_not_read(evidence: Evidence, manifest: Manifest) -> Cause:
    """Return the cause of `manifest.problem`, with the line of package.xml to look at."""
    problem = manifest.problem or ""
    data = evidence.submission.files[FILE]
    tag = ROS_1_TAGS.search(problem)
    if tag is not None:
        cause = f"<{tag['tag']}> belongs to ROS 1. In format 3, use <depend> or <exec_depend>."
        return Cause("package-xml-old-tag", cause, Where(FILE, line_of(data, f"<{tag['tag']}")))
    twice = TWICE.search(problem)
    if twice is not None:
        cause = f"The package {shorten(twice['name'])} is declared more than once."
        cause += " One tag <depend> is enough." if "generic" in problem else " Remove one of the tags."
        return Cause("package-xml-invalid", cause, _last_line(data, rf">\s*{re.escape(twice['name'])}\s*<"))
    other = UNKNOWN_TAG.search(problem)
    if other is not None:
        right = nearest(other["tag"], TAGS)
        cause = f"Format {other['format']} of {FILE} has no tag <{shorten(other['tag'], 30)}>."
        if other["tag"] in TAGS:
            cause += ' Write format="3" in the tag <package>.'
        elif right:
            cause += f" There is a tag <{right}>."
        return Cause("package-xml-invalid", cause, Where(FILE, line_of(data, f"<{other['tag']}")))
    if XML.search(problem):
        return _malformed(data, problem, manifest.line)
    for pattern, name, cause in RULES:
        if pattern in problem:
            return Cause("package-xml-invalid", cause, Where(FILE, line_of(data, rf"<{name}\b")))
    if "not at start" in problem:
        cause = "The first line must begin with <?xml. Remove the spaces and lines before it."
        return Cause("package-xml-invalid", cause, Where(FILE, manifest.line))
    return Cause("package-xml-invalid", where=Where(FILE, manifest.line or line_of(data, "<package")))


def _is_utf8(data: bytes) -> bool:
    try:
        data.decode("utf-8")
    except UnicodeDecodeError:
        return False
    return True


def _malformed(data: bytes, problem: str, line: int | None) -> Cause:
    """Return the reason why the file is not well-formed XML. `line` is the line at which the XML parser stopped."""
    if not data.startswith(UTF_16) and not _is_utf8(data):
        return Cause("not-utf8", "Save the file as UTF-8.", Where(FILE, line))
    text = _line_text(data, line)
    end = end_of_root(data)
    if end is not None and line is not None:
        last, at = end
        cause = f"</{shorten(last, 30)}> on line {at} closes the first tag. No text or tag may follow it"
        more = text.strip() if line > at else ""
        cause += f', but line {line} contains "{shorten(more, 30)}".' if more else "."
    elif "invalid token" in problem and re.search(r"<[^>]*$", _line_text(data, (line or 0) - 1).partition("<!--")[0]):
        line = (line or 0) - 1
        cause = f"The last tag on line {line} does not end: > is missing."
    elif re.search("mismatched tag|no element", problem) and open_tag(data)[0]:
        name, line = open_tag(data)
        cause = f"<{shorten(name, 30)}> on line {line} has no closing tag </{shorten(name, 30)}> in the right place."
    else:
        known = (each for of, of_line, each in MISTAKES if re.search(of, problem) and re.search(of_line, text))
        cause = next(known, "")
    return Cause("xml-malformed", cause, Where(FILE, line))


def _last_line(data: bytes, pattern: str) -> Where:
    lines = data.decode("utf-8", "replace").splitlines()
    return Where(FILE, max((number for number, line in enumerate(lines, 1) if re.search(pattern, line)), default=None))


def _line_text(data: bytes, number: int | None) -> str:
    """Return the line with this number (from 1), or an empty string."""
    lines = data.decode("utf-8", "replace").splitlines()
    return lines[number - 1] if number is not None and number <= len(lines) else ""
