"""The packages that a package needs for its tests, as colcon finds them in setup.py, setup.cfg and pyproject.toml.

colcon test runs pytest if pytest is listed in `extras_require` under one of the keys in TEST_KEYS
(colcon_core/package_augmentation/python.py). setuptools accepts a list, or a string with one requirement per line.
"""

from __future__ import annotations

import ast
import re
import sys
from typing import TYPE_CHECKING, Any

from grader.submission.constants import dotted, evaluate, written

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from grader.submission.code import Module

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

TEST_KEYS = ("test", "tests", "testing")
NAME = re.compile(r"[\w.-]+")
SECTION = "options.extras_require"


def extras_of_setup(given: ast.expr, module: Module) -> tuple[str, ...] | None:
    """Return the packages for tests in this value of `extras_require`, or None if its keys are unknown."""
    table = written(given, module.names)
    if isinstance(table, ast.Dict):
        keys = (None if key is None else evaluate(key, module.names) for key in table.keys)
        pairs = list(zip(keys, table.values, strict=True))
    elif isinstance(table, ast.Call) and dotted(table.func) == "dict" and not table.args:
        pairs = [(each.arg, each.value) for each in table.keywords]
    else:
        return None
    lines: list[str] = []
    for key, value in pairs:
        if key is None:
            return None
        if key in TEST_KEYS:
            lines += _lines(value, module)
    return names_in(lines)


def extras_of_files(files: Mapping[str, bytes]) -> tuple[str, ...]:
    """Return the names of the packages for tests in setup.cfg and pyproject.toml."""
    lines = list(_of_setup_cfg(files.get("setup.cfg", b"").decode("utf-8", "replace")))
    lines += _of_pyproject(files.get("pyproject.toml", b"").decode("utf-8", "replace"))
    return names_in(lines)


def names_in(lines: Iterable[str]) -> tuple[str, ...]:
    """Return the names of the packages in requirements such as "pytest >= 7"."""
    found = (NAME.match(line.strip()) for line in lines)
    return tuple(match.group() for match in found if match)


def _of_pyproject(text: str) -> Iterator[str]:
    try:
        project: Any = tomllib.loads(text).get("project")
    except (tomllib.TOMLDecodeError, RecursionError):
        return
    extras = project.get("optional-dependencies") if isinstance(project, dict) else None
    if isinstance(extras, dict):
        listed = [extras.get(key) for key in TEST_KEYS]
        yield from (line for lines in listed if isinstance(lines, list) for line in lines if isinstance(line, str))


def _of_setup_cfg(text: str) -> Iterator[str]:
    """Yield the lines that setup.cfg lists for tests. The text is read in a single pass."""
    section, key = "", ""
    for line in text.splitlines():
        if line.startswith("["):
            section, key = line.strip()[1:-1].strip(), ""
        elif line[:1].isspace():
            if section == SECTION and key in TEST_KEYS:
                yield line
        else:
            key, equals, value = (part.strip() for part in line.partition("=" if "=" in line else ":"))
            if section == SECTION and key in TEST_KEYS and equals:
                yield value


def _lines(node: ast.expr, module: Module) -> Iterator[str]:
    """Yield the requirements of a list, a tuple, a set, or a string with one requirement per line."""
    listed = written(node, module.names)
    parts = listed.elts if isinstance(listed, ast.List | ast.Tuple | ast.Set) else [] if listed is None else [listed]
    for part in parts:
        value = evaluate(part, module.names)
        yield from value.splitlines() if isinstance(value, str) else ()
