"""Checks of the submitted files and of the build: colcon built the package, and installed all required files."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.bad_entry_point import bad_entry_point, scripts_in_braces
from grader.checks.causes.bad_setup_cfg import why_setup_cfg_unreadable
from grader.checks.causes.crash import read_tracebacks
from grader.checks.causes.manifest_unread import why_not_read
from grader.checks.causes.syntax import unreadable_observed, why_unreadable
from grader.checks.causes.why_crashed import why_crashed
from grader.checks.kind import Kind, NoParams
from grader.checks.outcome import Finding, Status, failed, passed
from grader.common.words import a_list, shorten
from grader.submission.code import import_path
from grader.submission.package_xml import line_of
from grader.submission.plain_setup import only_calls_setup
from grader.submission.search import IGNORE_MARKER
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.checks.diagnosis import Diagnosis
    from grader.evidence.evidence import Evidence

INSTALLED_MODULE = re.compile(r"(?:local/)?lib/python[\d.]+/(?:site|dist)-packages/(?P<path>.+\.py)")
LAST_WORDS = re.compile(r"^(?:error|[\w.]*Error|[\w.]*Exception)\b.*", re.MULTILINE)
SETUP_PY_FRAME = re.compile(r"(?P<before>, in run_setup\n.*\n(?:[ ^~]+\n)?\s+File )\"<string>\"")
"""Matches the traceback entry for setup.py if colcon ran setup.py to read the arguments of setup()."""
UNREAD_SETUP = "return ast.literal_eval(output)"
"""The line in colcon's source that reads the arguments of setup()."""
UNNAMED = re.compile(r"And (?P<files>\d+) more\.")
"""Matches the last entry of `rejected` if this entry counts the files that are not listed by name."""
NO_FOLDER = re.compile(r"package directory '(?P<path>[^']+)' does not exist")
NO_FILE = re.compile(r"can't copy '?(?P<file>[^':]*)'?: doesn't exist")
IGNORE_MARKERS = (IGNORE_MARKER, "AMENT_IGNORE", "CATKIN_IGNORE")
"""Files with these names make colcon ignore a ROS 2 package."""
IGNORED = (
    "colcon ignores a folder that contains a file named COLCON_IGNORE, AMENT_IGNORE or CATKIN_IGNORE. "
    "Delete the file, so that colcon finds the package."
)
BY_SETUP_PY = "colcon builds an ament_python package by running its setup.py."
FOR_CPP = (
    "The package has a CMakeLists.txt, which colcon uses to build packages in C++. A package in Python needs a "
    "setup.py: `ros2 pkg create --build-type ament_python PACKAGE` creates a package with one."
)
EXPECTED = "`colcon build` succeeds and installs the package."
OTHER_TYPE = (
    "The build type in package.xml determines how colcon builds the package. This build type is not ament_python."
)


def plain_files(evidence: Evidence, _: NoParams) -> Finding:
    """The submission contains only files that the grader accepts."""
    rejected = evidence.submission.rejected
    if rejected:
        observed = f"Left out: {shorten(rejected[0], 150)}"
        rest = len(rejected) - 1
        if uncounted := UNNAMED.fullmatch(rejected[-1]):
            rest += int(uncounted["files"]) - 1
        more = f" (and {rest} more)." if rest else "."
        expected = "A package contains only normal files and folders of a limited size."
        return failed(observed.rstrip(".") + more, expected, Cause("rejected-file"))
    return passed("The package contains only normal files and folders.")


def builds(evidence: Evidence, _: NoParams) -> Finding:
    """Check that colcon builds the package and installs its Python modules."""
    build = evidence.built
    known = early(evidence, _)
    if known is not None:
        return known
    files = evidence.submission.files
    if build.timed_out and only_calls_setup(files["setup.py"], files.get("setup.cfg", b"")):
        message = f"`colcon build` was still running after {build.seconds:.0f} s, although setup.py only calls setup()."
        return Finding(Status.ERROR, f"{message} Try again when the machine is less busy.")
    if build.timed_out:
        cause = "setup.py should only call setup(). setup.py must not sleep, ask for input or loop."
        return failed(
            f"`colcon build` was still running after {build.seconds:.0f} s.",
            EXPECTED,
            Cause("build-timeout", cause, Where("setup.py", _setup_line(evidence))),
        )
    if build.out_of is not None:
        observed = f"`colcon build` used all the {shorten(build.out_of, 40)} that a package may use."
        return failed(observed, EXPECTED, Cause("build-limit", "setup.py should only call setup().", Where("setup.py")))
    if build.exit_code != 0 or build.package is None:
        return _broken(evidence)
    return _modules(evidence)


def early(evidence: Evidence, _: NoParams) -> Finding | None:
    """Return a failed finding if the files alone show that no build can succeed, else None."""
    ignored = next((name for name in IGNORE_MARKERS if name in evidence.submission.files), None)
    if ignored is not None:
        observed = f"colcon ignores the package, because its folder contains a file {ignored}."
        return failed(observed, EXPECTED, Cause("colcon-ignore", IGNORED, Where(ignored)))
    setup = evidence.setup_py
    if setup is None:
        cause = FOR_CPP if "CMakeLists.txt" in evidence.submission.files else BY_SETUP_PY
        where = Where("package.xml") if "package.xml" in evidence.submission.files else None
        return failed("There is no setup.py next to package.xml.", EXPECTED, Cause("setup-py-missing", cause, where))
    if setup.unreadable is None:
        return None
    why = why_unreadable("setup.py", setup.unreadable, evidence.submission.files["setup.py"])
    observed = unreadable_observed("setup.py", setup.unreadable)
    where = why.where or Where("setup.py", setup.unreadable.line)
    return failed(observed, EXPECTED, Cause("setup-py-syntax", why.text, where))


def _broken(evidence: Evidence) -> Finding:
    build, setup = evidence.built, evidence.setup_py
    assert setup is not None
    bad = next((point for point in setup.entry_points or () if point.target is None), None)
    if bad is not None:
        return bad_entry_point(bad)
    raised = scripts_in_braces(evidence.submission.files["setup.py"]) or _raised(evidence)
    if raised is not None:
        return raised
    where = Where("setup.py", _setup_line(evidence))
    if UNREAD_SETUP in build.log:
        observed = "colcon could not read the arguments of setup() in setup.py."
        cause = "setup.py should only call setup(). setup.py must not print anything or exit."
        printed = _line_of(evidence, r"^\s*(?:print|exit|quit|sys\.exit)\(")
        return failed(observed, EXPECTED, Cause("setup-py-output", cause, printed or where))
    if build.exit_code == 0:
        observed = "`colcon build` finished but installed nothing."
        return failed(observed, EXPECTED, Cause("nothing-installed", where=where))
    words = [line for line in LAST_WORDS.findall(build.log) if "CalledProcessError" not in line]
    message = f": {shorten(words[-1], 150)}" if words else f" (exit code {build.exit_code})"
    missing = NO_FILE.search(words[-1]) if words else None
    if missing is not None:
        cause = "data_files in setup.py lists a file that does not exist in the package."
        diagnosis: Diagnosis = "package-xml-missing" if missing["file"] == "package.xml" else "data-file-missing"
        last = missing["file"].rstrip("/").rpartition("/")[2]
        if _is_folder(evidence, missing["file"]):
            cause = (
                f"data_files in setup.py lists {shorten(missing['file'])}, which is a folder. List its files instead."
            )
        elif last == setup.name != evidence.exercise.package:
            cause += f" The name of the file comes from the package name {shorten(last)}."
            where = Where("setup.py", setup.name_line)
        marker = missing["file"].startswith("resource/")
        named = _line_of(evidence, r"['\"]resource/" if marker else rf"['\"/]{re.escape(last)}['\"]")
        return failed(f"`colcon build` failed{message}.", EXPECTED, Cause(diagnosis, cause, named or where))
    folder = NO_FOLDER.search(words[-1]) if words else None
    if folder is not None:
        cause = f"packages or package_dir in setup.py names the folder {shorten(folder['path'])}, which does not exist."
        named = _line_of(evidence, r"\bpackage_dir\b", r"\bpackages\b") or where
        return failed(f"`colcon build` failed{message}.", EXPECTED, Cause("build-failed", cause, named))
    other = _other_type(evidence)
    why = Cause("build-failed", OTHER_TYPE, other) if other is not None else Cause("build-failed", where=where)
    return failed(f"`colcon build` failed{message}.", EXPECTED, why)


def _is_folder(evidence: Evidence, path: str) -> bool:
    return any(file.startswith(f"{path.rstrip('/')}/") for file in evidence.submission.files)


def _line_of(evidence: Evidence, *patterns: str) -> Where | None:
    """Return the first line of setup.py that matches a pattern, or None.

    If lines match different patterns, the first pattern decides.
    """
    line = line_of(evidence.submission.files["setup.py"], *patterns)
    return None if line is None else Where("setup.py", line)


def _raised(evidence: Evidence) -> Finding | None:
    """Return a failed finding if setup.py raised an exception in the build, else None."""
    log = SETUP_PY_FRAME.sub(r'\g<before>"setup.py"', evidence.built.log)
    crashes = [crash for _, crash in read_tracebacks(log, evidence.submission.files) if crash.where is not None]
    if not crashes:
        return None
    unreadable = why_setup_cfg_unreadable(evidence.submission.files.get("setup.cfg", b""))
    if unreadable is not None:
        return failed("setup.cfg cannot be read.", EXPECTED, unreadable)
    why = why_crashed(evidence, crashes[0]).at(crashes[0].where)
    return failed(f"setup.py failed: {crashes[0].observed}.", EXPECTED, Cause("setup-py-raises", why.text, why.where))


def _other_type(evidence: Evidence) -> Where | None:
    """Return the line of the build type in package.xml if this type is not ament_python, else None."""
    manifest = evidence.manifest
    if manifest is None or manifest.problem is not None or manifest.build_type == "ament_python":
        return None
    data = evidence.submission.files["package.xml"]
    return Where("package.xml", line_of(data, "<build_type>", r"depend>\s*catkin", "<export>"))


def _modules(evidence: Evidence) -> Finding:
    """Return the finding about the installed modules: colcon may install nothing and still return exit code 0."""
    files = evidence.submission.files
    modules = [import_path(path) for path in files if path.endswith(".py")]
    folders = sorted({path.partition("/")[0] for path in modules if path.count("/") == 1} - {"test", "tests", "launch"})
    bare = [folder for folder in folders if f"{folder}/__init__.py" not in modules]
    finds = evidence.setup_py is not None and evidence.setup_py.finds_packages
    missing = not any(INSTALLED_MODULE.fullmatch(path) for path in evidence.built.installed) and not is_linked(evidence)
    if (missing or (finds and is_linked(evidence))) and bare and len(bare) == len(folders):
        observed = (
            f"`colcon build` installed none of the Python files: the folder {shorten(bare[0])} has no __init__.py."
        )
        expected = "Each folder with Python files has a file __init__.py, which can be empty."
        cause = "find_packages in setup.py finds only folders with an __init__.py." if finds else ""
        return failed(observed, expected, Cause("missing-init", cause, Where("setup.py", _setup_line(evidence))))
    # If colcon cannot read package.xml, it reports the exception from setup.py and continues.
    raised = _raised(evidence) if missing else None
    if raised is not None:
        return raised
    if missing:
        observed = "`colcon build` finished but installed none of the Python files."
        other = _other_type(evidence)
        if other is not None:
            return failed(observed, EXPECTED, Cause("nothing-installed", OTHER_TYPE, other))
        cause = "The packages argument of setup() lists the folders to install."
        setup = evidence.setup_py
        line = (setup.packages_line if setup is not None else None) or _setup_line(evidence)
        return failed(observed, EXPECTED, Cause("nothing-installed", cause, Where("setup.py", line)))
    return passed("`colcon build` built and installed the package.")


def is_linked(evidence: Evidence) -> bool:
    """Return whether the build used --symlink-install, which does not copy the modules."""
    return any(path.endswith(".egg-link") for path in evidence.built.installed)


def _setup_line(evidence: Evidence) -> int | None:
    return evidence.setup_py.setup_line if evidence.setup_py is not None else None


def installs(evidence: Evidence, _: NoParams) -> Finding:
    """package.xml and the marker file in the resource index are installed: ROS 2 uses both to find the package."""
    installed = evidence.built.installed
    name = _package_name(evidence)
    wanted = {
        f"share/ament_index/resource_index/packages/{name}": f"the marker file resource/{name}",
        f"share/{name}/package.xml": "package.xml",
    }
    missing = [words for path, words in wanted.items() if path not in installed]
    manifest = evidence.manifest
    if manifest is not None and manifest.problem is not None:
        observed = "colcon cannot read package.xml, so it built a plain Python package."
        expected = "colcon builds a ROS 2 package, which `ros2 run` finds."
        return failed(observed, expected, why_not_read(evidence, manifest))
    if not missing:
        return passed("ROS 2 finds the installed package.")
    where = Where("setup.py", _setup_line(evidence))
    observed = f"Not installed: {a_list(missing)}."
    expected = "data_files in setup.py installs the marker file into the resource index, and package.xml into share."
    diagnosis: Diagnosis = "resource-marker" if "marker" in missing[0] else "package-xml-not-installed"
    return failed(
        observed, expected, Cause(diagnosis, "`ros2 run` and other tools use these files to find a package.", where)
    )


def _package_name(evidence: Evidence) -> str:
    """Return the name under which colcon installs the package."""
    if evidence.built.package is not None:
        return evidence.built.package
    manifest, setup = evidence.manifest, evidence.setup_py
    if manifest is not None and manifest.name:
        return manifest.name
    return (setup.name if setup is not None else None) or evidence.exercise.package


PLAIN_FILES = Kind(
    "plain_files",
    "source",
    "The package contains only normal files",
    NoParams,
    plain_files,
    about="The submission contains only normal files and folders of a limited size: for example, no devices, and no "
    "links that lead out of the package.",
)
BUILDS = Kind(
    "builds",
    "build",
    "colcon builds the package",
    NoParams,
    builds,
    early=early,
    about="`colcon build` succeeds and installs the Python modules of the package.",
)
INSTALLS = Kind(
    "installs",
    "build",
    "ROS 2 can find the installed package",
    NoParams,
    installs,
    about="package.xml and the marker for the resource index are installed, so that ROS 2 finds the package.",
)
