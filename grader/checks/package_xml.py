"""Checks of package.xml: it is valid, declares what the code uses, and names the package as all else does."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.code import import_path
from grader.checks.kind import Kind, NoParams, texts
from grader.checks.manifest import line_of
from grader.outcome import Finding, Where, failed, passed
from grader.words import a_list, nearest, shorten

if TYPE_CHECKING:
    from grader.checks.evidence import Evidence

FILE = "package.xml"
BUILD_TYPE = "ament_python"


def _line(evidence: Evidence, *patterns: str) -> Where:
    return Where(FILE, line_of(evidence.submission.files[FILE], *patterns))


def valid(evidence: Evidence, _: NoParams) -> Finding:
    """package.xml is there, catkin_pkg can read it, and it asks for the build type ament_python."""
    manifest = evidence.manifest
    expected = f"a {FILE} with name, version, description, maintainer, license and the build type {BUILD_TYPE}"
    if manifest is None:
        cause = "setup.py alone makes a Python package; package.xml is what makes it a ROS 2 package."
        return failed(
            "package-xml-missing", f"There is no {FILE} beside setup.py.", f"A package has {expected}.", cause
        )
    if manifest.problem is not None:
        where = Where(FILE, manifest.line)
        seen = f"{FILE} cannot be read: {manifest.problem}."
        return failed("package-xml-invalid", seen, f"The lesson shows {expected}.", where=where)
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


@dataclass(frozen=True, kw_only=True)
class Dependencies:
    """`packages`: the names that must be declared for running."""

    packages: tuple[str, ...] = texts()


def dependencies(evidence: Evidence, params: Dependencies) -> Finding:
    """package.xml declares these packages as <depend> or <exec_depend>."""
    manifest = evidence.manifest
    expected = f"It declares {a_list(params.packages)}."
    if manifest is None or manifest.problem is not None:
        return failed("package-xml-invalid", f"There is no {FILE} that can be read.", expected)
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
    guess = nearest(missing[0], set(manifest.run_depends) - set(params.packages))
    cause = (
        f'It has "{shorten(guess)}": is that a typing error?'
        if guess
        else "Here the node runs all the same, since the package is installed; on another machine it may not be."
    )
    return failed("missing-depend", f"{FILE} does not declare {a_list(missing)}.", expected, cause, where=where)


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
        return failed("package-folder", f"There is no folder {wanted} with Python files.", expected, cause)
    return passed(f"package.xml, setup.py and the folder agree on the name {wanted}.")


def _dash(name: str) -> str:
    return "A ROS 2 package's name has underscores, not dashes." if "-" in name else ""


VALID = Kind("package_xml", "source", "package.xml is valid", NoParams, valid)
DEPENDENCIES = Kind("dependencies", "source", "package.xml declares what the node uses", Dependencies, dependencies)
NAME = Kind("package_name", "source", "The package's name is the same everywhere", NoParams, name)
