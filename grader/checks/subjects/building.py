"""Checks of the build: colcon built the package, and what was meant to be installed is in the install tree."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from grader.checks.causes.bad_entry_point import bad_entry_point
from grader.checks.causes.crash import read_tracebacks
from grader.checks.causes.syntax import unreadable_seen, why_unreadable
from grader.checks.kind import Kind, NoParams
from grader.checks.outcome import Finding, failed, passed
from grader.common.words import a_list, shorten
from grader.submission.code import import_path
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence

INSTALLED_MODULE = re.compile(r"(?:local/)?lib/python[\d.]+/(?:site|dist)-packages/(?P<path>.+\.py)")
LAST_WORDS = re.compile(r"^(?:error|[\w.]*Error|[\w.]*Exception)\b.*", re.MULTILINE)
SETUP_PY_FRAME = re.compile(r"(?P<before>, in run_setup\n.*\n(?:[ ^~]+\n)?\s+File )\"<string>\"")
"""How setup.py itself appears in a traceback where colcon runs it to learn what setup() is given."""
UNREAD_SETUP = "return ast.literal_eval(output)"
"""colcon's own line that reads what setup() was given."""
NO_FILE = re.compile(r"can't copy .*: doesn't exist")
EXPECTED = "`colcon build` ends without an error and installs the package."


def plain_files(evidence: Evidence, _: NoParams) -> Finding:
    """Nothing in the submission had to be left out."""
    rejected = evidence.submission.rejected
    if rejected:
        seen = f"Left out: {shorten(rejected[0], 150)}"
        more = f" (and {len(rejected) - 1} more)." if len(rejected) > 1 else "."
        return failed("rejected-file", seen.rstrip(".") + more, "A package is plain files and folders of its own.")
    return passed("The package is plain files and folders.")


def builds(evidence: Evidence, _: NoParams) -> Finding:
    """The package builds with colcon, which installs its Python modules."""
    build = evidence.built
    known = early(evidence, _)
    if known is not None:
        return known
    if build.timed_out:
        cause = "setup.py should only call setup(): it must not wait, ask or loop."
        return failed(
            "build-timeout",
            f"`colcon build` was still running after {build.seconds:.0f} s.",
            EXPECTED,
            cause,
            where=Where("setup.py", _setup_line(evidence)),
        )
    if build.out_of is not None:
        seen = f"`colcon build` used up the {shorten(build.out_of, 40)} that a package may use."
        return failed("build-limit", seen, EXPECTED, "setup.py should only call setup().", where=Where("setup.py"))
    if build.exit_code != 0:
        return _broken(evidence)
    return _modules(evidence)


def early(evidence: Evidence, _: NoParams) -> Finding | None:
    """What keeps the package from being built, whatever colcon says: a setup.py that is not there, or not Python."""
    setup = evidence.setup_py
    if setup is None:
        cause = "colcon builds an ament_python package by running its setup.py."
        where = Where("package.xml") if "package.xml" in evidence.submission.files else None
        return failed("setup-py-missing", "There is no setup.py beside package.xml.", EXPECTED, cause, where=where)
    if setup.unreadable is None:
        return None
    why = why_unreadable(setup.unreadable, evidence.submission.files["setup.py"])
    seen = unreadable_seen("setup.py", setup.unreadable)
    return failed("setup-py-syntax", seen, EXPECTED, why.text, where=Where("setup.py", setup.unreadable.line))


def _broken(evidence: Evidence) -> Finding:
    build, setup = evidence.built, evidence.setup_py
    assert setup is not None
    bad = next((point for point in setup.entry_points or () if point.target is None), None)
    if bad is not None:
        return bad_entry_point(bad)
    log = SETUP_PY_FRAME.sub(r'\g<before>"setup.py"', build.log)
    crashes = [crash for _, crash in read_tracebacks(log, evidence.submission.files) if crash.where is not None]
    if crashes:
        crash = crashes[0]
        return failed("setup-py-raises", f"setup.py failed: {crash.seen}.", EXPECTED, crash.meaning, where=crash.where)
    where = Where("setup.py", _setup_line(evidence))
    if UNREAD_SETUP in build.log:
        seen = "colcon could not read from setup.py what setup() was given."
        cause = "setup.py should only call setup(): it must not print anything, nor end the program."
        return failed("setup-py-output", seen, EXPECTED, cause, where=where)
    words = [line for line in LAST_WORDS.findall(build.log) if "CalledProcessError" not in line]
    said = f": {shorten(words[-1], 150)}" if words else f" (exit code {build.exit_code})"
    if words and NO_FILE.search(words[-1]):
        cause = "setup.py names a file in data_files that the package does not have."
        return failed("data-file-missing", f"`colcon build` failed{said}.", EXPECTED, cause, where=where)
    return failed("build-failed", f"`colcon build` failed{said}.", EXPECTED, _other_type(evidence), where=where)


def _other_type(evidence: Evidence) -> str:
    """A cause in words where package.xml makes colcon take the package for one of another kind; else empty."""
    manifest = evidence.manifest
    if manifest is None or manifest.problem is not None or manifest.build_type == "ament_python":
        return ""
    return "colcon goes by package.xml, which is not that of an ament_python package."


def _modules(evidence: Evidence) -> Finding:
    """Exit code 0 is not enough: the modules must be there."""
    files = evidence.submission.files
    modules = [import_path(path) for path in files if path.endswith(".py")]
    folders = sorted({path.partition("/")[0] for path in modules if path.count("/") == 1} - {"test", "tests", "launch"})
    bare = [folder for folder in folders if f"{folder}/__init__.py" not in modules]
    finds = evidence.setup_py is not None and evidence.setup_py.finds_packages
    missing = not any(INSTALLED_MODULE.fullmatch(path) for path in evidence.built.installed) and not is_linked(evidence)
    if (missing or (finds and is_linked(evidence))) and bare and len(bare) == len(folders):
        seen = f"`colcon build` installed none of the Python files: the folder {shorten(bare[0])} has no __init__.py."
        expected = "A folder with a file __init__.py (it may be empty) is a Python package."
        cause = "find_packages in setup.py finds only such folders." if finds else ""
        return failed("missing-init", seen, expected, cause, where=Where("setup.py", _setup_line(evidence)))
    if missing:
        seen = "`colcon build` said that it was done, and installed none of the Python files."
        cause = _other_type(evidence) or "The argument packages of setup() says which folders to install."
        return failed("nothing-installed", seen, EXPECTED, cause, where=Where("setup.py", _setup_line(evidence)))
    return passed("`colcon build` built and installed the package.")


def is_linked(evidence: Evidence) -> bool:
    """True after --symlink-install, which leaves the modules where they are."""
    return any(path.endswith(".egg-link") for path in evidence.built.installed)


def _setup_line(evidence: Evidence) -> int | None:
    return evidence.setup_py.setup_line if evidence.setup_py is not None else None


def installs(evidence: Evidence, _: NoParams) -> Finding:
    """The files by which ROS 2 finds a package are installed: package.xml and the marker in the resource index."""
    installed = evidence.built.installed
    name = _package_name(evidence)
    wanted = {
        f"share/ament_index/resource_index/packages/{name}": f"the marker resource/{name}",
        f"share/{name}/package.xml": "package.xml",
    }
    missing = [words for path, words in wanted.items() if path not in installed]
    if not missing:
        return passed("ROS 2 finds the installed package.")
    where = Where("setup.py", _setup_line(evidence))
    seen = f"Not installed: {a_list(missing)}."
    expected = "data_files in setup.py installs the marker into the resource index, and package.xml into share."
    diagnosis = "resource-marker" if "marker" in missing[0] else "package-xml-not-installed"
    return failed(diagnosis, seen, expected, "By these files `ros2 run` and other tools find a package.", where=where)


def _package_name(evidence: Evidence) -> str:
    """The name that colcon installs the package by."""
    if evidence.built.package is not None:
        return evidence.built.package
    manifest, setup = evidence.manifest, evidence.setup_py
    if manifest is not None and manifest.name:
        return manifest.name
    return (setup.name if setup is not None else None) or evidence.exercise.package


PLAIN_FILES = Kind(
    "plain_files",
    "source",
    "The package is plain files",
    NoParams,
    plain_files,
    about="The submission holds only files and folders: no link that leads out of it, no device, no huge file.",
)
BUILDS = Kind(
    "builds",
    "build",
    "colcon builds the package",
    NoParams,
    builds,
    early=early,
    about="`colcon build` ends without an error and installs the package's Python modules.",
)
INSTALLS = Kind(
    "installs",
    "build",
    "The package can be found once it is installed",
    NoParams,
    installs,
    about="package.xml and the marker for the resource index are installed, so that ROS 2 finds the package.",
)
