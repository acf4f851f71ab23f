"""PlainSetup: a setup.py of the usual form, in which everything that affects the installed files is constant.

Most packages have a setup.py of this form. This module reads setup.py with `ast` and never runs it. For any other
setup.py, the result is None.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING

from grader.submission.code import read_module
from grader.submission.constants import dotted, evaluate, written
from grader.submission.setup_py import read_setup_py

if TYPE_CHECKING:
    from collections.abc import Collection

    from grader.submission.code import Module
    from grader.submission.setup_py import SetupPy

NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
"""Matches package names that setuptools does not normalize."""
_VERSION = re.compile(r"(0|[1-9]\d*)(\.(0|[1-9]\d*))*")
_POINT = re.compile(r"(?P<name>[A-Za-z0-9]\w*)\s*=\s*(?P<target>[A-Za-z_][\w.]*:[A-Za-z_]\w*)")
_IMPORTED = frozenset({"setuptools", "os"})
_CALLED = frozenset({"setup", "setuptools.setup", "find_packages", "setuptools.find_packages", "os.path.join"})
"""The functions that a plain setup.py may call. Any other function could depend on the modules of the package."""
_ONLY_METADATA = frozenset(
    {
        *("author", "author_email", "maintainer", "maintainer_email", "url", "description", "long_description"),
        *("license", "keywords", "classifiers", "install_requires", "tests_require", "extras_require", "zip_safe"),
    }
)
"""Arguments of setup() that affect only the metadata of the package, which nodes do not read."""
_INSTALLED = frozenset({"name", "version", "packages", "data_files", "entry_points"})
_CONFIGURATION = frozenset({"[develop]", "script_dir=$base/lib/{}", "[install]", "install_scripts=$base/lib/{}"})


@dataclass(frozen=True)
class PlainSetup:
    """The arguments of setup(): `packages` are dotted names, and `data_files` are (folder, path of the file) pairs.

    `entry_points` maps the names of the console_scripts to "module:attribute".
    """

    name: str
    version: str
    packages: tuple[str, ...]
    data_files: tuple[tuple[str, str], ...]
    entry_points: dict[str, str]


def read_plain_setup(setup_py: bytes, setup_cfg: bytes, paths: Collection[str]) -> PlainSetup | None:
    """Read the setup.py and setup.cfg of a package with files at these paths. Return None if their form is unusual."""
    module = read_module("setup.py", setup_py)
    given = _arguments(module)
    if given is None or not given.keys() >= _INSTALLED:
        return None
    name, version = evaluate(given["name"], module.names), evaluate(given["version"], module.names)
    packages = _packages(given["packages"], module, paths)
    setup = read_setup_py(setup_py)
    data_files, entry_points = _data_files(setup), _entry_points(setup)
    if not isinstance(name, str) or not NAME.fullmatch(name) or not _is_plain(setup_cfg, name):
        return None
    if not isinstance(version, str) or not _VERSION.fullmatch(version):
        return None
    if packages is None or data_files is None or entry_points is None:
        return None
    return PlainSetup(name, version, packages, data_files, entry_points)


def only_calls_setup(setup_py: bytes, setup_cfg: bytes) -> bool:
    """Return whether setup.py only calls setup() with the usual arguments, and setup.cfg has the usual form.

    Of the values of the arguments, only that of `name` is examined.
    """
    module = read_module("setup.py", setup_py)
    name = evaluate((_arguments(module) or {}).get("name"), module.names)
    return isinstance(name, str) and _is_plain(setup_cfg, name)


def _arguments(module: Module) -> dict[str, ast.expr] | None:
    """Return the arguments of setup(), or None if the module or the arguments are unusual."""
    call = _only_call(module)
    if call is None or call.args:
        return None
    given = {keyword.arg: keyword.value for keyword in call.keywords if keyword.arg is not None}
    return given if len(given) == len(call.keywords) and given.keys() <= _INSTALLED | _ONLY_METADATA else None


def _only_call(module: Module) -> ast.Call | None:
    """Return the call to setup(), or None if the module has calls or statements that a plain setup.py does not have."""
    calls: list[ast.Call] = []
    for statement in module.body:
        if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Call):
            calls.append(statement.value)
        elif isinstance(statement, ast.Import | ast.ImportFrom):
            names = [statement.module] if isinstance(statement, ast.ImportFrom) else [a.name for a in statement.names]
            renamed = any(alias.asname for alias in statement.names)
            if renamed or not _IMPORTED.issuperset(name.partition(".")[0] if name else "" for name in names):
                return None
        elif isinstance(statement, ast.Assign):
            if not all(isinstance(target, ast.Name) and target.id != "setup" for target in statement.targets):
                return None
        elif not (isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)):
            return None
    called = [dotted(node.func) for node in module.nodes if isinstance(node, ast.Call)]
    if len(calls) != 1 or dotted(calls[0].func) not in ("setup", "setuptools.setup") or not _CALLED.issuperset(called):
        return None
    return calls[0]


def _is_plain(setup_cfg: bytes, name: str) -> bool:
    """Return whether setup.cfg has only the lines that put the scripts where `ros2 run` looks for them."""
    lines = [line.strip() for line in setup_cfg.decode("utf-8", "replace").splitlines()]
    kept = [re.sub(r"\s*=\s*", "=", line) for line in lines if line and not line.startswith("#")]
    wanted = {line.format(name) for line in _CONFIGURATION}
    return len(kept) == len(wanted) and {line.replace("-", "_") for line in kept} == wanted


def _packages(node: ast.expr, module: Module, paths: Collection[str]) -> tuple[str, ...] | None:
    node = written(node, module.names) or node
    present = {path.removesuffix("/__init__.py").replace("/", ".") for path in paths if path.endswith("/__init__.py")}
    if isinstance(node, ast.List):
        listed = [evaluate(item, module.names) for item in node.elts]
        return tuple(map(str, listed)) if present.issuperset(listed) else None
    if not isinstance(node, ast.Call) or dotted(node.func) not in ("find_packages", "setuptools.find_packages"):
        return None
    if node.args or any(keyword.arg != "exclude" for keyword in node.keywords):
        return None
    excluded: list[str] = []
    for keyword in node.keywords:
        if not isinstance(keyword.value, ast.List | ast.Tuple):
            return None
        patterns = [evaluate(item, module.names) for item in keyword.value.elts]
        if not all(isinstance(pattern, str) for pattern in patterns):
            return None
        excluded += map(str, patterns)
    found = [name for name in present if all(around in present for around in _around(name))]
    return tuple(sorted(name for name in found if not any(fnmatchcase(name, pattern) for pattern in excluded)))


def _around(name: str) -> list[str]:
    """Return the names of the parent packages of the Python package `name`."""
    parts = name.split(".")
    return [".".join(parts[:depth]) for depth in range(1, len(parts))]


def _data_files(setup: SetupPy) -> tuple[tuple[str, str], ...] | None:
    pairs = [(folder, path) for folder, files in setup.data_files or () for path in files or [""]]
    plain = all(_is_plain_path(part) for pair in pairs for part in pair)
    return tuple(pairs) if pairs and plain else None


def _is_plain_path(path: str) -> bool:
    return all(re.fullmatch(r"\w[\w.-]*", part) for part in path.split("/"))


def _entry_points(setup: SetupPy) -> dict[str, str] | None:
    if setup.entry_points is None or setup.groups != ("console_scripts",):
        return None
    matches = [_POINT.fullmatch(point.text.strip()) for point in setup.entry_points]
    found = {match["name"]: match["target"] for match in matches if match}
    return found if found and len(found) == len(setup.entry_points) else None
