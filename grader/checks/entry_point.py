"""Check of the entry point: `ros2 run PACKAGE EXECUTABLE` finds a function to call."""

from __future__ import annotations

import ast
import re
from typing import TYPE_CHECKING

from grader.checks.building import INSTALLED_MODULE, is_linked
from grader.checks.code import import_path, module_file, read_code, read_module
from grader.checks.kind import Kind, NoParams
from grader.outcome import Finding, Where, failed, passed
from grader.words import nearest, shorten

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.checks.code import Module
    from grader.checks.evidence import Evidence

FORM = "An entry point reads NAME = PACKAGE.MODULE:FUNCTION, in the list console_scripts of setup.py"
NOT_UTF8 = re.compile(r"codec can't decode|unicode error|[Nn]on-UTF-8|encoding")
"""What Python says of a file whose bytes are not the text that they should be."""
DATA = (ast.Constant, ast.List, ast.Tuple, ast.Dict, ast.Set, ast.JoinedStr)
"""Expressions whose value nobody can call."""


def entry_point(evidence: Evidence, _: NoParams) -> Finding:
    """The executable is installed where `ros2 run` looks, and leads to a callable of a module that Python can read."""
    executable, build = evidence.exercise.executable, evidence.built
    target = build.entry_points.get(executable)
    if target is None:
        return _missing(evidence)
    if executable not in build.executables:
        folder = f"lib/{build.package or evidence.exercise.package}"
        seen = f"{executable} was not installed into the package's own folder, {folder}."
        expected = "setup.cfg says where executables go, so that `ros2 run` finds them."
        cause = (
            "setup.cfg is missing."
            if "setup.cfg" not in evidence.submission.files
            else "Compare it with the lesson's, letter by letter."
        )
        where = Where("setup.cfg") if "setup.cfg" in evidence.submission.files else None
        return failed("setup-cfg", seen, expected, cause, where=where)
    module, _colon, attribute = target.partition(":")
    return _resolve(evidence, module.strip(), attribute.split("[")[0].strip())


def _line(evidence: Evidence) -> Where:
    """The line of setup.py with the exercise's entry point, else with the call of setup()."""
    setup = evidence.setup_py
    point = setup.entry_point(evidence.exercise.executable) if setup is not None else None
    return Where("setup.py", point.line if point is not None else setup.setup_line if setup is not None else None)


def _missing(evidence: Evidence) -> Finding:
    """No executable of that name was installed; look at what is there instead."""
    executable, setup = evidence.exercise.executable, evidence.setup_py
    expected = f"{FORM}; NAME is {executable}."
    others = sorted(set(evidence.built.entry_points) | set(evidence.built.executables))
    points = (setup.entry_points if setup is not None else None) or ()
    joined = next((point for point in points if point.text.count("=") > 1), None)
    if joined is not None:
        cause = "A comma is missing between two entry points, so Python joins the two texts."
        return failed(
            "entry-point-comma",
            f'An entry point reads "{shorten(joined.text, 90)}".',
            expected,
            cause,
            where=Where("setup.py", joined.line),
        )
    guess = nearest(executable, others)
    if guess is not None and guess != executable:
        where = next((Where("setup.py", point.line) for point in points if point.name == guess), _line(evidence))
        return failed(
            "entry-point-name",
            f"There is no executable {executable}; there is {shorten(guess)}.",
            expected,
            where=where,
        )
    seen = f"The package has no executable {executable}."
    if setup is not None and setup.groups and "console_scripts" not in setup.groups:
        cause = f'entry_points has the group "{shorten(setup.groups[0])}"; executables come from console_scripts.'
        return failed("entry-point-group", seen, expected, cause, where=_line(evidence))
    file = evidence.node_file or _looks_like_a_node(evidence, [point.target for point in points])
    if file is not None:
        cause = f"{shorten(file)} is there, but setup.py does not name it: a file alone is no executable."
        return failed("entry-point-missing", seen, expected, cause, where=_line(evidence))
    return failed("entry-point-missing", seen, expected, where=_line(evidence))


def _looks_like_a_node(evidence: Evidence, targets: list[str | None]) -> str | None:
    """A file that makes a publisher, and that no entry point leads to."""
    taken = [module_file((target or "").partition(":")[0], evidence.submission.files) for target in targets]
    everything = read_code(evidence.submission.files, first=None)
    files = [call.module.file for call in everything.calls("create_publisher")]
    return next((file for file in files if file not in taken), None)


def _resolve(evidence: Evidence, module_name: str, attribute: str) -> Finding:
    files = evidence.submission.files
    file = module_file(module_name, files)
    if file is None:
        return _no_module(evidence, module_name)
    if not _is_installed(evidence, file):
        seen = f"{file} is not installed, so {module_name} cannot be imported."
        cause = "The argument packages of setup() leaves its folder out, or the folder has no __init__.py."
        return failed(
            "module-not-installed",
            seen,
            f"The entry point {evidence.exercise.executable} needs it.",
            cause,
            where=_line(evidence),
        )
    module = read_module(file, files[file])
    if module.tree is None and module.unreadable is None:
        return passed(f"The entry point {evidence.exercise.executable} leads to {file}.")
    if module.unreadable is not None:
        where = Where(file, module.unreadable.line)
        seen = f"Python cannot read {file}: {shorten(module.unreadable.message, 120)}."
        if NOT_UTF8.search(module.unreadable.message):
            return failed("not-utf8", seen, "A file saved as UTF-8.", "Say UTF-8 when you save it.", where=where)
        cause = "Often the fault is at the end of the line before: a bracket, a colon, the indentation."
        return failed("syntax-error", seen, "A file that Python can read.", cause, where=where)
    return _attribute(evidence, module, attribute)


def _no_module(evidence: Evidence, module_name: str) -> Finding:
    files = evidence.submission.files
    executable = evidence.exercise.executable
    seen = f"The entry point {executable} leads to the module {shorten(module_name)}, which is not there."
    modules = [
        import_path(path)[: -len(".py")].replace("/", ".") for path in files if path.endswith(".py") and "/" in path
    ]
    if module_name.endswith(".py"):
        cause = "A module is named without the ending .py."
    else:
        guess = nearest(module_name, modules)
        cause = f"There is a module {shorten(guess)}." if guess else ""
    expected = "A module is named by its folder and file, as in FOLDER.FILE."
    return failed("entry-point-module", seen, expected, cause, where=_line(evidence))


def _is_installed(evidence: Evidence, file: str) -> bool:
    if is_linked(evidence):
        return True
    matches = (INSTALLED_MODULE.fullmatch(path) for path in evidence.built.installed)
    return any(match["path"] == import_path(file) for match in matches if match is not None)


def _attribute(evidence: Evidence, module: Module, attribute: str) -> Finding:
    executable = evidence.exercise.executable
    name = attribute.partition(".")[0]
    if not name:
        seen = f"The entry point {executable} leads to {module.file}, and names no function in it."
        return failed(
            "entry-point-function", seen, f"{FORM}.", "The part with the colon is missing.", where=_line(evidence)
        )
    bound = list(_bindings(module, name))
    if not bound:
        defined = [node.name for node in module.nodes if isinstance(node, ast.FunctionDef) and node.col_offset == 0]
        guess = nearest(name, defined)
        seen = f"The entry point {executable} leads to the function {shorten(name)}, which {module.file} does not have."
        cause = (
            f"It has {shorten(guess)}."
            if guess
            else "A function inside of a class does not count: look at its indentation."
        )
        return failed(
            "entry-point-function", seen, "A function at the top level of the file.", cause, where=_line(evidence)
        )
    last = bound[-1]
    if isinstance(last, ast.Assign | ast.AnnAssign) and isinstance(last.value, DATA):
        seen = f"The entry point {executable} leads to {shorten(name)}, which is no function."
        return failed(
            "entry-point-not-callable", seen, "A function, made with def.", where=Where(module.file, last.lineno)
        )
    return passed(f"The entry point {executable} leads to {shorten(name)} in {module.file}.")


def _bindings(module: Module, name: str) -> Iterator[ast.stmt]:
    """The statements of the module's top level (blocks of if, try and with opened) that give the name a value."""
    waiting = list(module.tree.body) if module.tree is not None else []
    while waiting:
        node = waiting.pop(0)
        if _binds(node, name):
            yield node
        if isinstance(node, ast.If | ast.Try | ast.With | ast.For | ast.While):
            inner = [child for child in ast.iter_child_nodes(node) if isinstance(child, ast.stmt)]
            handlers = [child for child in ast.iter_child_nodes(node) if isinstance(child, ast.ExceptHandler)]
            waiting = inner + [stmt for handler in handlers for stmt in handler.body] + waiting


def _binds(node: ast.stmt, name: str) -> bool:
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return node.name == name
    if isinstance(node, ast.Import | ast.ImportFrom):
        return any((alias.asname or alias.name.partition(".")[0]) in (name, "*") for alias in node.names)
    if isinstance(node, ast.Assign):
        return any(
            isinstance(part, ast.Name) and part.id == name for target in node.targets for part in ast.walk(target)
        )
    return isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and node.target.id == name


ENTRY_POINT = Kind("entry_point", "build", "The entry point leads to a function", NoParams, entry_point)
