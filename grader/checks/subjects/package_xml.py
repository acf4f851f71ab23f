"""Checks of package.xml: it is valid, declares the packages that the code uses, and has the right package name."""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.manifest_unread import why_not_read
from grader.checks.causes.ros_names import MODULE_OF, PACKAGE, SHARED_NAMES
from grader.checks.kind import Kind, NoParams, choice, strings
from grader.checks.outcome import Finding, failed, passed
from grader.common.words import a_list, nearest, shorten
from grader.submission.code import import_path, imported_packages
from grader.submission.package_xml import line_of
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from grader.evidence.evidence import Evidence
    from grader.submission.code import Code
    from grader.submission.package_xml import Manifest

FILE = "package.xml"
BUILD_TYPE = "ament_python"
EXPECTED_BUILD_TYPE = f"A Python package has the build type {BUILD_TYPE}."
CATKIN = "catkin"
KNOWN = frozenset({module.partition(".")[0] for module in MODULE_OF.values()} | {"rclpy", "sensor_msgs", "nav_msgs"})
"""Common ROS 2 packages. A name that is slightly different from one of these names is a typo."""


def _line(evidence: Evidence, *patterns: str) -> Where:
    return Where(FILE, line_of(evidence.submission.files[FILE], *patterns))


def valid(evidence: Evidence, _: NoParams) -> Finding:
    """package.xml exists, catkin_pkg can read it, and its build type is ament_python."""
    manifest = evidence.manifest
    expected = f"a {FILE} with name, version, description, maintainer, license and the build type {BUILD_TYPE}"
    if manifest is None:
        cause = "setup.py alone makes a Python package. package.xml makes it a ROS 2 package."
        return failed(
            f"There is no {FILE} next to setup.py.",
            f"A package has {expected}.",
            Cause("package-xml-missing", cause, Where("setup.py")),
        )
    if manifest.problem is not None:
        observed = f"{FILE} cannot be read: {manifest.problem}."
        return failed(observed, f"The lesson shows {expected}.", why_not_read(evidence, manifest))
    if manifest.build_type != BUILD_TYPE and CATKIN in manifest.other_depends:
        cause = f"{CATKIN} is the build tool of ROS 1. Did you follow an old tutorial?"
        where = _line(evidence, CATKIN)
        return failed(f"{FILE} requires {CATKIN}.", EXPECTED_BUILD_TYPE, Cause("ros-1-package-xml", cause, where))
    if manifest.build_type != BUILD_TYPE:
        observed = f"The build type is {shorten(manifest.build_type or 'missing')}."
        cause = (
            f"Without <build_type>{BUILD_TYPE}</build_type> in <export>, colcon does not treat the folder as a Python "
            "package."
        )
        return failed(
            observed, EXPECTED_BUILD_TYPE, Cause("build-type", cause, _line(evidence, "<build_type>", "<export>"))
        )
    return passed(f"{FILE} is valid.")


@dataclass(frozen=True, kw_only=True)
class Dependencies:
    """The packages that package.xml must declare as dependencies at run time."""

    packages: tuple[str, ...] = strings(about="The packages that must be declared.")
    imports: str = choice(
        "any",
        "declared",
        about='With "declared", the ROS 2 packages that the nodes of the exercise import must be declared too.',
    )


def dependencies(evidence: Evidence, params: Dependencies) -> Finding:
    """package.xml declares these packages (and imported ROS 2 packages, if required) as <depend> or <exec_depend>.

    It does not declare a class, such as Twist, as if the class were a package.
    """
    manifest = evidence.manifest
    imported = _imported(evidence) if params.imports == "declared" else {}
    needed = tuple(dict.fromkeys((*params.packages, *imported)))
    expected = f"{FILE} declares {a_list(needed)}."
    if manifest is None or manifest.problem is not None:
        return failed(
            f"{FILE} is missing or cannot be read.", expected, Cause("package-xml-invalid", where=Where(FILE))
        )
    missing = [name for name in needed if name not in manifest.run_depends]
    if not missing:
        return _class_declared(evidence, manifest.run_depends, expected) or passed(expected)
    late = [name for name in missing if name in manifest.other_depends]
    if late:
        observed = f"{FILE} declares {a_list(late)} only for building or testing."
        cause = (
            "<build_depend> and <test_depend> do not count when the node runs. <depend> covers "
            "building, testing and running."
        )
        where = _line(evidence, rf">\s*{re.escape(late[0])}\s*<")
        return failed(observed, expected, Cause("depend-kind", cause, where))
    observed = f"{FILE} does not declare {a_list(missing)}."
    return failed(observed, expected, _why_not_declared(evidence, manifest, missing, needed, imported))


def _class_declared(evidence: Evidence, declared: Iterable[str], expected: str) -> Finding | None:
    """Return the failed finding if a class such as Twist is declared as if it were a package, else None."""
    found = [name for name in declared if name in MODULE_OF and name not in SHARED_NAMES and name[0].isupper()]
    if not found:
        return None
    package = MODULE_OF[found[0]].partition(".")[0]
    observed = f"{FILE} also declares {found[0]}, which is not a package."
    cause = f"{found[0]} is a class in the package {package}. Declare only packages."
    where = _line(evidence, rf">\s*{re.escape(found[0])}\s*<")
    return failed(observed, expected, Cause("depend-on-class", cause, where))


def _imported(evidence: Evidence) -> dict[str, Where]:
    """Return the ROS 2 packages that the nodes of the exercise import, with the line of the first import.

    A misspelt package, whose name is slightly different from a known one, is left out. A package that is known not to
    have any of the names that are imported from it is left out too: the mistake is in the import, not in package.xml.
    """
    found: dict[str, Where] = {}
    for trial in evidence.exercise.trials:
        view = evidence.from_trial(trial.id)
        for package, where in imported_packages(view.code, evidence.submission.files).items():
            exists = package in KNOWN or nearest(package, KNOWN) is None
            if PACKAGE.fullmatch(package) and exists and not _has_none_of_these(view.code, package):
                found.setdefault(package, where)
    return found


def _has_none_of_these(code: Code, package: str) -> bool:
    """Return whether every name that the nodes import from this package is known to belong to another package."""
    names = [
        alias.name
        for module in code.modules
        for node in module.nodes
        if isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] == package
        for alias in node.names
    ]
    elsewhere = [MODULE_OF[name].partition(".")[0] for name in names if name in MODULE_OF and name not in SHARED_NAMES]
    return package in KNOWN and bool(names) and len(elsewhere) == len(names) and package not in elsewhere


def _declared_inside(evidence: Evidence, begin: str, end: str, package: str) -> Where | None:
    """Return the place of a tag that declares the package between `begin` and `end`, or None."""
    pattern = rf"{begin}(?:(?!{end}).)*depend>\s*{re.escape(package)}\s*<"
    found = re.search(pattern, _text(evidence), re.DOTALL)
    return Where(FILE, _text(evidence)[: found.end()].count("\n") + 1) if found is not None else None


def _why_not_declared(
    evidence: Evidence, manifest: Manifest, missing: Sequence[str], needed: Sequence[str], imported: Mapping[str, Where]
) -> Cause:
    """Return the reason why package.xml does not declare the packages in `missing`, such as a typo or a comment."""
    name = missing[0]
    guess = nearest(name, [each for each in manifest.run_depends if each not in needed and not _used(evidence, each)])
    if guess is not None:
        cause = f'The file declares "{shorten(guess)}". Is that a typo?'
        return Cause("depend-misspelt", cause, _line(evidence, re.escape(guess)))
    comment = _declared_inside(evidence, "<!--", "-->", name)
    if comment is not None:
        cause = "The line is inside a comment, between <!-- and -->, so it does not count."
        return Cause("depend-commented-out", cause, comment)
    module = next((each for each in manifest.run_depends if each.startswith(f"{name}.")), None)
    if module is not None:
        cause = f"{shorten(module)} is a module of the package {name}. Declare the package."
        return Cause("depend-on-class", cause, _line(evidence, re.escape(module)))
    exported = _declared_inside(evidence, "<export>", "</export>", name)
    if exported is not None:
        cause = "The line is inside <export>, which does not declare dependencies. Move the line above <export>."
        return Cause("missing-depend", cause, exported)
    where = _line(evidence, r"<\w*depend\b", "</license>")
    setup = evidence.setup_py
    if setup is not None and name in setup.required:
        return Cause(
            "depend-in-setup-py", f"install_requires in setup.py is for pip packages. ROS 2 reads {FILE}.", where
        )
    names, them = a_list(missing), "it" if len(missing) == 1 else "them"
    cause = "On another computer, rosdep installs only the packages that package.xml declares."
    used = [each for each in missing if each in imported]
    if used:
        cause = f"{imported[used[0]]} imports {used[0]}. {cause}"
    elif imported:
        cause = f"The task needs {names}, although your code does not import {them} yet. {cause}"
    return Cause("missing-depend", cause, where)


def _used(evidence: Evidence, package: str) -> bool:
    """Return whether any Python file of the submission imports the package. If so, its name is not a typo."""
    line = re.compile(rf"^\s*(from|import)\s+{re.escape(package)}\b".encode(), re.MULTILINE)
    return any(path.endswith(".py") and line.search(data) for path, data in evidence.submission.files.items())


def _text(evidence: Evidence) -> str:
    return evidence.submission.files[FILE].decode("utf-8", "replace")


def name(evidence: Evidence, _: NoParams) -> Finding:
    """package.xml, setup.py and the folder of the Python modules have the package name of the exercise."""
    wanted = evidence.exercise.package
    manifest, setup = evidence.manifest, evidence.setup_py
    expected = f"package.xml, setup.py and the folder with the Python files have the name {wanted}."
    if manifest is not None and manifest.problem is None and manifest.name != wanted:
        observed = f"The package name in package.xml is {shorten(manifest.name)}."
        return failed(observed, expected, Cause("package-name", _dash(manifest.name), _line(evidence, "<name>")))
    if setup is not None and setup.name is not None and setup.name != wanted:
        observed = f"The package name in setup.py is {shorten(setup.name)}."
        return failed(observed, expected, Cause("package-name", _dash(setup.name), Where("setup.py", setup.name_line)))
    modules = [import_path(path) for path in evidence.submission.files if path.endswith(".py")]
    if not any(path.startswith(f"{wanted}/") for path in modules):
        folders = {path.partition("/")[0] for path in modules if path.count("/") == 1}
        guess = nearest(wanted, folders)
        cause = f"A similar folder exists: {shorten(guess)}." if guess else ""
        return failed(
            f"There is no folder {wanted} with Python files.",
            expected,
            Cause("package-folder", cause, Where("setup.py")),
        )
    return passed(expected)


def _dash(name: str) -> str:
    return "ROS 2 package names use underscores, not dashes." if "-" in name else ""


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
    about="package.xml declares the required packages with `<depend>` or `<exec_depend>`, and declares no class, such "
    "as Twist.",
)
NAME = Kind(
    "package_name",
    "source",
    "The package name is the same everywhere",
    NoParams,
    name,
    about="package.xml, setup.py and the folder of the modules have the package name from `[exercise]`.",
)
