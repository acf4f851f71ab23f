"""Checks of package.xml: it is valid, declares what the code uses, and names the package as all else does."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.kind import Kind, NoParams, texts
from grader.checks.outcome import Finding, failed, passed
from grader.common.words import a_list, nearest, shorten
from grader.submission.code import import_path
from grader.submission.package_xml import line_of, open_tag
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.submission.package_xml import Manifest

FILE = "package.xml"
BUILD_TYPE = "ament_python"
CATKIN = "catkin"
XML = re.compile(
    r"mismatched tag|not well-formed|no element found|junk after|unclosed|duplicate attribute|invalid XML|syntax error"
    r"|invalid token|undefined entity"
)
"""What an XML parser says of a text that is no XML."""
ROS_1_TAGS = re.compile(r"must not contain the following tags: .*\b(?P<tag>run_depend)\b")


def _line(evidence: Evidence, *patterns: str) -> Where:
    return Where(FILE, line_of(evidence.submission.files[FILE], *patterns))


def valid(evidence: Evidence, _: NoParams) -> Finding:
    """package.xml is there, catkin_pkg can read it, and it asks for the build type ament_python."""
    manifest = evidence.manifest
    expected = f"a {FILE} with name, version, description, maintainer, license and the build type {BUILD_TYPE}"
    if manifest is None:
        cause = "setup.py alone makes a Python package; package.xml is what makes it a ROS 2 package."
        return failed(
            "package-xml-missing",
            f"There is no {FILE} beside setup.py.",
            f"A package has {expected}.",
            cause,
            where=Where("setup.py"),
        )
    if manifest.problem is not None:
        return _unreadable(evidence, manifest, f"The lesson shows {expected}.")
    if manifest.build_type != BUILD_TYPE and CATKIN in manifest.other_depends:
        cause = f"{CATKIN} is the build tool of ROS 1; an old tutorial or package may be behind it."
        where = _line(evidence, CATKIN)
        return failed(
            "ros-1-package-xml", f"{FILE} asks for {CATKIN}.", f"A Python package has {BUILD_TYPE}.", cause, where=where
        )
    if manifest.build_type != BUILD_TYPE:
        seen = f"The build type is {shorten(manifest.build_type or 'missing')}."
        cause = (
            f"Without <build_type>{BUILD_TYPE}</build_type> in <export>, colcon takes it for another kind of package."
        )
        return failed(
            "build-type",
            seen,
            f"A Python package has {BUILD_TYPE}.",
            cause,
            where=_line(evidence, "<build_type>", "<export>"),
        )
    return passed(f"{FILE} is valid.")


def _unreadable(evidence: Evidence, manifest: Manifest, expected: str) -> Finding:
    problem = manifest.problem or ""
    seen = f"{FILE} cannot be read: {problem}."
    tag = ROS_1_TAGS.search(problem)
    if tag is not None:
        cause = f"<{tag['tag']}> is of format 1, that of ROS 1; format 3 has <exec_depend>, and <depend> for all."
        return failed("package-xml-old-tag", seen, expected, cause, where=_line(evidence, f"<{tag['tag']}"))
    if XML.search(problem):
        cause = "Each <tag> ends with a </tag> of the same name, the inner one before the outer one."
        line = manifest.line
        if "mismatched tag" in problem:
            tag_, line = open_tag(evidence.submission.files[FILE])
            cause = f"<{shorten(tag_, 30)}> in line {line} is not closed by a tag of the same name with a slash."
        elif "junk after" in problem:
            cause = "After the last tag, </package>, nothing may follow."
        return failed("xml-malformed", seen, expected, cause, where=Where(FILE, line))
    return failed(
        "package-xml-invalid", seen, expected, where=Where(FILE, manifest.line or _line(evidence, "<package").line)
    )


@dataclass(frozen=True, kw_only=True)
class Dependencies:
    """`packages`: the names that must be declared for running."""

    packages: tuple[str, ...] = texts(about="The packages that must be declared.")


def dependencies(evidence: Evidence, params: Dependencies) -> Finding:
    """package.xml declares these packages as <depend> or <exec_depend>."""
    manifest = evidence.manifest
    expected = f"It declares {a_list(params.packages)}."
    if manifest is None or manifest.problem is not None:
        return failed("package-xml-invalid", f"There is no {FILE} that can be read.", expected, where=Where(FILE))
    missing = [name for name in params.packages if name not in manifest.run_depends]
    if not missing:
        return passed(f"{FILE} declares {a_list(params.packages)}.")
    where = _line(evidence, r"<\w*depend\b", "</license>")
    late = [name for name in missing if name in manifest.other_depends]
    if late:
        cause = "<build_depend> and <test_depend> do not count for running; <depend> counts for all."
        return failed(
            "depend-kind", f"{FILE} declares {a_list(late)}, but not for running.", expected, cause, where=where
        )
    seen = f"{FILE} does not declare {a_list(missing)}."
    guess = nearest(missing[0], set(manifest.run_depends) - set(params.packages))
    if guess is not None:
        cause = f'It has "{shorten(guess)}": is that a typing error?'
        return failed("depend-misspelt", seen, expected, cause, where=_line(evidence, re.escape(guess)))
    comment = re.search(rf"<!--(?:(?!-->).)*\b{re.escape(missing[0])}\b", _text(evidence), re.DOTALL)
    if comment is not None:
        cause = "The line is inside of a comment, between <!-- and -->, where nobody reads it."
        line = _text(evidence)[: comment.end()].count("\n") + 1
        return failed("depend-commented-out", seen, expected, cause, where=Where(FILE, line))
    setup = evidence.setup_py
    if setup is not None and missing[0] in setup.required:
        cause = f"install_requires in setup.py is for packages of pip. ROS 2 reads {FILE}."
        return failed("depend-in-setup-py", seen, expected, cause, where=where)
    cause = "Here the node runs all the same, since the package is installed; on another machine it may not be."
    return failed("missing-depend", seen, expected, cause, where=where)


def _text(evidence: Evidence) -> str:
    return evidence.submission.files[FILE].decode("utf-8", "replace")


def name(evidence: Evidence, _: NoParams) -> Finding:
    """The name in package.xml, the name in setup.py and the folder of the Python modules are the exercise's package."""
    wanted = evidence.exercise.package
    manifest, setup = evidence.manifest, evidence.setup_py
    expected = f"The name is {wanted} in package.xml, in setup.py and of the folder with the Python files."
    if manifest is not None and manifest.problem is None and manifest.name != wanted:
        seen = f"package.xml names the package {shorten(manifest.name)}."
        return failed("package-name", seen, expected, _dash(manifest.name), where=_line(evidence, "<name>"))
    if setup is not None and setup.name is not None and setup.name != wanted:
        seen = f"setup.py names the package {shorten(setup.name)}."
        return failed("package-name", seen, expected, _dash(setup.name), where=Where("setup.py", setup.name_line))
    modules = [import_path(path) for path in evidence.submission.files if path.endswith(".py")]
    if not any(path.startswith(f"{wanted}/") for path in modules):
        folders = {path.partition("/")[0] for path in modules if path.count("/") == 1}
        guess = nearest(wanted, folders)
        cause = f"There is a folder {shorten(guess)}." if guess else ""
        return failed(
            "package-folder",
            f"There is no folder {wanted} with Python files.",
            expected,
            cause,
            where=Where("setup.py"),
        )
    return passed(f"package.xml, setup.py and the folder agree on the name {wanted}.")


def _dash(name: str) -> str:
    return "A ROS 2 package's name has underscores, not dashes." if "-" in name else ""


VALID = Kind(
    "package_xml",
    "source",
    "package.xml is valid",
    NoParams,
    valid,
    about="package.xml exists, is valid, and has the build type ament_python.",
)
DEPENDENCIES = Kind(
    "dependencies",
    "source",
    "package.xml declares what the node uses",
    Dependencies,
    dependencies,
    about="package.xml declares the packages for running, with `<depend>` or `<exec_depend>`.",
)
NAME = Kind(
    "package_name",
    "source",
    "The package's name is the same everywhere",
    NoParams,
    name,
    about="package.xml, setup.py and the folder of the modules have the name that `package` in `[exercise]` gives.",
)
