"""Predict the install tree of a usual package from its source, without running anything.

A node can start from the predicted tree while colcon is still building. The behaviour of this node counts only if
colcon installs the same files (grader.colcon.comparison). For a package that is unusual in any way, nothing is
predicted.
"""

from __future__ import annotations

import ast
import io
import re
import sys
import tarfile
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from textwrap import dedent
from typing import TYPE_CHECKING

from grader.submission.code import module_file, read_code
from grader.submission.package_xml import read_manifest
from grader.submission.plain_setup import read_plain_setup

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping

    from grader.ros.installation import Ros
    from grader.submission.package import Submission
    from grader.submission.plain_setup import PlainSetup

PYTHON = f"{sys.version_info.major}.{sys.version_info.minor}"
SITE = f"lib/python{PYTHON}/site-packages"
"""The folder of the modules in install/<package>."""
_OTHER_BUILDS = frozenset({"pyproject.toml", "CMakeLists.txt", "COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE"})
"""Files that change what colcon or setuptools installs."""
_TEMPLATE = re.compile(r'r"""\n([ \t]*# EASY-INSTALL-ENTRY-SCRIPT: %\(spec\)r.*?)"""', re.DOTALL)
_SHEBANG = re.compile(r"/[\w./-]{1,100}")
"""Matches the interpreter paths that setuptools writes without quotes into the first line of a script."""
_IMPORTED = frozenset(
    {
        *("rclpy", "action_msgs", "builtin_interfaces", "example_interfaces", "geometry_msgs", "nav_msgs"),
        *("rcl_interfaces", "rosgraph_msgs", "sensor_msgs", "std_msgs", "std_srvs", "turtlesim", "__future__"),
        *("abc", "cmath", "collections", "contextlib", "copy", "dataclasses", "datetime", "enum", "functools"),
        *("itertools", "math", "numpy", "operator", "random", "signal", "statistics", "sys", "threading", "time"),
        *("traceback", "typing"),
    }
)
"""The modules and packages that nodes usually import. If a node imports anything else from outside the
submission, that module could read the folder in which the node is installed, so nothing is predicted."""
_READING = frozenset(
    {"open", "exec", "eval", "compile", "__import__", "__file__", "__path__", "__spec__", "__loader__"}
)
"""Names with which a node could read files, or find the folder in which it is installed. If a node uses one of these
names, nothing is predicted."""


@dataclass(frozen=True)
class Predicted:
    """The files that a node can use from install/<package>: their content and permissions, by relative path."""

    package: str
    files: Mapping[str, tuple[bytes, int]]
    metadata: str
    """The folder to which setuptools adds files that a node does not read."""

    @property
    def tree(self) -> bytes:
        """The install tree as a tar stream, in the same form as the install tree of a build."""
        stream = io.BytesIO()
        with tarfile.open(fileobj=stream, mode="w", format=tarfile.GNU_FORMAT) as tar:
            for path, (content, mode) in self.files.items():
                member = tarfile.TarInfo(f"{self.package}/{path}")
                member.size, member.mode = len(content), mode
                tar.addfile(member, io.BytesIO(content))
        return stream.getvalue()


def predict(submission: Submission, ros: Ros, executables: Collection[str]) -> Predicted | None:
    """Return the files that colcon will install, or None if the package or one of these executables is unusual.

    Call this through `grader.submission.reader.read`.
    """
    files = submission.files
    if submission.rejected or not _OTHER_BUILDS.isdisjoint(files) or not files.keys() >= {"setup.py", "setup.cfg"}:
        return None
    setup = read_plain_setup(files["setup.py"], files["setup.cfg"], files.keys())
    manifest = read_manifest(files.get("package.xml", b""))
    template, python = _template(), str(ros.python)
    if setup is None or template is None or not _SHEBANG.fullmatch(python):
        return None
    if (manifest.name, manifest.build_type) != (setup.name, "ament_python"):
        return None
    if any(_may_look_around(setup.entry_points.get(name), files) for name in executables):
        return None
    return _installed(setup, submission, template, python)


def _installed(setup: PlainSetup, submission: Submission, template: str, python: str) -> Predicted | None:
    files, name = submission.files, setup.name
    metadata = f"{SITE}/{name}-{setup.version}-py{PYTHON}.egg-info"
    modules = [path for path in files if _is_module(path, setup.packages)]
    data = {f"{folder}/{path.rpartition('/')[2]}": path for folder, path in setup.data_files}
    marker, manifest = f"share/ament_index/resource_index/packages/{name}", f"share/{name}/package.xml"
    usual = data.get(marker) == f"resource/{name}" and data.get(manifest) == "package.xml"
    if not usual or not files.keys() >= set(data.values()) or len(data) < len(setup.data_files):
        return None
    spec = f"{name.replace('_', '-')}=={setup.version}"
    points = sorted(f"{point} = {target}\n" for point, target in setup.entry_points.items())
    scripts = {
        f"lib/{name}/{point}": f"#!{python}\n" + template % {"spec": spec, "group": "console_scripts", "name": point}
        for point in setup.entry_points
    }
    installed = {
        **{f"{SITE}/{path}": (files[path], 0o644) for path in modules},
        f"{metadata}/entry_points.txt": (f"[console_scripts]\n{''.join(points)}".encode(), 0o644),
        **{path: (text.encode(), 0o755) for path, text in scripts.items()},
        **{to: (files[path], 0o755 if path in submission.executable else 0o644) for to, path in data.items()},
    }
    return Predicted(name, installed, metadata)


def _is_module(path: str, packages: tuple[str, ...]) -> bool:
    folder, _, file = path.rpartition("/")
    return folder.replace("/", ".") in packages and file.endswith(".py") and not file.startswith(".")


def _may_look_around(target: str | None, files: Mapping[str, bytes]) -> bool:
    """Return whether a node could read files that are not modules, or could notice that such files are missing."""
    file = module_file(target.partition(":")[0], files) if target else None
    if file is None:
        return True
    return any(_looks_around(node, files) for module in read_code(files, file).modules for node in module.nodes)


def _looks_around(node: ast.AST, files: Mapping[str, bytes]) -> bool:
    if isinstance(node, ast.Import):
        names = [alias.name for alias in node.names]
    elif isinstance(node, ast.ImportFrom) and not node.level:
        names = [node.module or ""]
    else:
        attribute = node.attr if isinstance(node, ast.Attribute) else ""  # such as helper.__file__, but not re.compile
        found = node.id if isinstance(node, ast.Name) else attribute if attribute.startswith("__") else ""
        return found in _READING
    packages = {name.partition(".")[0] for name in names}
    return any(name not in _IMPORTED and module_file(name, files) is None for name in packages)


def _template() -> str | None:
    """Return the text that setuptools writes into the script of an entry point, or None. setuptools is not imported."""
    found = find_spec("setuptools")
    if found is None or found.origin is None:
        return None
    file = Path(found.origin).parent / "command" / "easy_install.py"
    match = _TEMPLATE.search(file.read_text(encoding="utf-8")) if file.is_file() else None
    return dedent(match[1]).lstrip() if match else None
