"""Check of the entry point: `ros2 run PACKAGE EXECUTABLE` finds a function to call."""

from __future__ import annotations

import ast
from contextlib import suppress
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.no_entry_point import FORM, indented, line, no_entry_point
from grader.checks.causes.syntax import unreadable_finding
from grader.checks.causes.why_own_import import without_init
from grader.checks.edit import at
from grader.checks.kind import Kind, NoParams
from grader.checks.outcome import Finding, failed, passed
from grader.checks.subjects.building import INSTALLED_MODULE, is_linked
from grader.common.words import a_list, nearest, shorten
from grader.errors import TooLargeError
from grader.submission.code import import_path, module_file, read_module
from grader.submission.constants import dotted
from grader.submission.package_xml import line_of
from grader.submission.where import Where

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from grader.checks.edit import Edit
    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module

OTHER_ENDINGS = ("", ".txt", ".py.txt", ".PY", ".python")
"""The endings that the name of a Python file may have by mistake, instead of .py."""
INIT = "/__init__.py"
"""The end of the path of the file that Python runs if a module name is the name of a folder."""
DATA = (ast.Constant, ast.List, ast.Tuple, ast.Dict, ast.Set, ast.JoinedStr)
"""Expressions whose value is not callable."""


def entry_point(evidence: Evidence, _: NoParams) -> Finding:
    """`ros2 run` finds the executable, and its entry point names a callable in a module that Python can read."""
    executable, build = evidence.trial.executable, evidence.built
    target = build.entry_points.get(executable)
    if target is None:
        return no_entry_point(evidence)
    if executable not in build.executables:
        folder = f"lib/{build.package or evidence.exercise.package}"
        observed = f"{executable} was not installed in the folder of the package, {folder}."
        expected = "setup.cfg sets the folder for executables, so that `ros2 run` finds them."
        cause, where = "setup.cfg is missing.", Where("setup.py")
        if (setup_cfg := evidence.submission.files.get("setup.cfg")) is not None:
            where = Where("setup.cfg", line_of(setup_cfg, "^install[_-]scripts"))
            cause = "install_scripts must be $base/lib/ and the name of the package."
            if build.package not in (None, evidence.exercise.package):
                cause = "The folder name must be the package name in package.xml."
            elif where.line is None:
                cause = "setup.cfg has no line that begins with install_scripts."
            elif line_of(setup_cfg, rf"^install[_-]scripts\s*[=:]\s*\$base/{folder}\s*$"):
                cause = "install_scripts must be in the section [install]."
        return failed(observed, expected, Cause("setup-cfg", cause, where))
    module, _colon, attribute = target.partition(":")
    return _resolve(evidence, module.strip(), attribute.split("[")[0].strip())


def _resolve(evidence: Evidence, module_name: str, attribute: str) -> Finding:
    files = evidence.submission.files
    file = module_file(module_name, files)
    if file is None:
        return _no_module(evidence, module_name)
    if not _is_installed(evidence, file):
        observed = f"{file} is not installed, so {module_name} cannot be imported."
        cause = "The packages argument of setup() does not list the module's folder, or the folder has no __init__.py."
        if "/" not in file:
            cause = f"{file} is next to setup.py. The file belongs in the folder {evidence.exercise.package}."
        why = without_init(evidence, file) or Cause("module-not-installed", cause)
        expected = f"The entry point {evidence.trial.executable} needs this module."
        return failed(observed, expected, why.at(line(evidence)))
    module = read_module(file, files[file])
    if module.unreadable is not None:
        return unreadable_finding(file, module.unreadable, files[file])
    return _attribute(evidence, module, attribute)


def _no_module(evidence: Evidence, module_name: str) -> Finding:
    files = evidence.submission.files
    executable = evidence.trial.executable
    observed = f"The entry point {executable} names the module {shorten(module_name)}, which does not exist."
    expected = "A module name has the form FOLDER.FILE."
    if module_name.endswith(".py"):
        cause = "Write the module name without the ending .py."
        why = Cause("entry-point-py", cause, line(evidence))
        return failed(observed, expected, why.fixed_by(at(why.where, ".py:", ":")))
    outer, _dot, last = module_name.rpartition(".")
    file = module_file(outer, files) if outer else None
    if file is not None and any(_bindings(read_module(file, files[file]), last)):
        cause = f"{shorten(last)} is a name in {file}. Write a colon between the module and the function, not a dot."
        why = Cause("entry-point-no-function", cause, line(evidence))
        return failed(observed, f"{FORM}.", why.fixed_by(at(why.where, module_name, f"{outer}:{last}")))
    right = _similar_module(module_name, files)
    if module_name in evidence.exercise.package or "." not in module_name:
        cause = "Write the folder first, then a dot, then the file name without .py."
    elif f"{last}.py" in files:
        cause = f"{last}.py is next to setup.py. The file belongs in the folder {shorten(outer)}."
    elif (other := _other_ending(module_name, files)) is not None:
        cause = f"There is a file {shorten(other)}, but the name of a Python file must end with .py."
    else:
        cause = (
            f"A similar module exists: {shorten(right)}."
            if right is not None
            else "Compare the module name with the names of your files."
        )
    fix = at(line(evidence), module_name, right) if right is not None else ()
    return failed(observed, expected, Cause("entry-point-module", cause, line(evidence)).fixed_by(fix))


def _similar_module(name: str, files: Collection[str]) -> str | None:
    """Return the module whose folder and file name are each equal or similar to those in `name`, or None."""
    modules = [
        import_path(path).removesuffix(".py").removesuffix("/__init__").replace("/", ".")
        for path in files
        if path.endswith(".py") and "/" in path
    ]
    return nearest(name, [each for each in modules if _alike(name, each)])


def _other_ending(name: str, files: Collection[str]) -> str | None:
    """Return the file that would be this module if its name ended with .py, or None."""
    path = name.replace(".", "/")
    return next((each for each in files if import_path(each) in {path + ending for ending in OTHER_ENDINGS}), None)


def _alike(module: str, other: str) -> bool:
    """Return whether the folders of two modules, and the last parts of their names, are each the same or similar."""
    (folder, _, name), (other_folder, _, other_name) = module.rpartition("."), other.rpartition(".")
    return all(each == its or nearest(each, [its]) for each, its in ((folder, other_folder), (name, other_name)))


def _is_installed(evidence: Evidence, file: str) -> bool:
    if is_linked(evidence):
        return True
    matches = (INSTALLED_MODULE.fullmatch(path) for path in evidence.built.installed)
    return any(match["path"] == import_path(file) for match in matches if match is not None)


def _attribute(evidence: Evidence, module: Module, attribute: str) -> Finding:
    executable = evidence.trial.executable
    name = attribute.partition(".")[0]
    if not name:
        observed = f"The entry point {executable} names the module in {module.file}, but no function."
        cause = "After the module, write a colon and the function name."
        return failed(observed, f"{FORM}.", Cause("entry-point-no-function", cause, line(evidence)))
    bound = list(_bindings(module, name))
    if not bound:
        return _no_function(evidence, module, name)
    last = bound[-1]
    if isinstance(last, ast.Assign | ast.AnnAssign) and isinstance(last.value, DATA):
        observed = f"The entry point {executable} names {shorten(name)}, which is not a function."
        return failed(
            observed,
            "The entry point names a function that is defined with def.",
            Cause("entry-point-not-callable", where=Where(module.file, last.lineno)),
        )
    return passed(f"The entry point {executable} names {shorten(name)} in {module.file}.")


def _no_function(evidence: Evidence, module: Module, name: str) -> Finding:
    executable = evidence.trial.executable
    inside = indented(module, name)
    beside = _files_beside(evidence, module)
    others = [each.file for each in beside if any(_bindings(each, name))]
    if inside is None and (others or (beside and not module.nodes[1:])):
        return _only_the_folder(evidence, module, name, others)
    if not module.nodes[1:]:
        expected = f"The file contains the function {shorten(name)}, which the entry point names."
        where = Where(module.file)
        return failed(
            f"{module.file} contains no code.", expected, Cause("empty-file", "Did you save the file?", where)
        )
    observed = f"The entry point {executable} names {shorten(name)}, which is not at the top level of {module.file}."
    expected = "The function is at the top level of the file."
    functions = [node for node in module.nodes if isinstance(node, ast.FunctionDef)]
    at_top = next((node for node in module.nodes if isinstance(node, ast.Call) and _is_top_level(module, node)), None)
    if at_top is not None and not any(node.name == name for node in functions):
        cause = "The program's code is at the top level of the file. Move the code into a function with that name."
        return failed(observed, expected, Cause("top-level-code", cause, Where(module.file, at_top.lineno)))
    if inside is not None:
        return failed(observed, expected, inside)
    guess = nearest(name, [node.name for node in functions if node.col_offset == 0])
    top = [node.name for node in functions if node.col_offset == 0]
    cause = "Nothing at the top level of the file has that name."
    if guess or len(top) == 1:
        cause = f"The file has a function {shorten(guess or top[0])}."
    right = guess or (top[0] if len(top) == 1 else None)
    fix = at(line(evidence), f":{name}", f":{right}") if right is not None else ()
    return failed(observed, expected, Cause("entry-point-function", cause, line(evidence)).fixed_by(fix))


def _files_beside(evidence: Evidence, module: Module) -> list[Module]:
    """Return the other modules in the folder of an __init__.py. The list is empty if `module` is another file."""
    folder, init, _ = module.file.rpartition(INIT)
    sources = evidence.submission.files if init else {}
    found = []
    for file in sources:
        if file.endswith(".py") and file.rpartition("/")[0] == folder and file != module.file:
            with suppress(TooLargeError):
                found.append(read_module(file, sources[file]))
    return found


def _only_the_folder(evidence: Evidence, module: Module, name: str, others: list[str]) -> Finding:
    """Return a failed finding about an entry point that names a folder. `others` are its files with the function."""
    executable, folder = evidence.trial.executable, module.file.removesuffix(INIT)
    package = import_path(folder).replace("/", ".")
    observed = f"The entry point {executable} names the folder {shorten(package)}, but no file in it."
    others = [each for each in others if each == f"{folder}/{executable}.py"] or sorted(others)
    fix: tuple[Edit, ...] = ()
    cause = f"Python looks for {shorten(name)} in __init__.py. To name another file, write FOLDER.FILE."
    if others:
        files = a_list([shorten(each) for each in others], most=3)
        cause = f"Python looks for {shorten(name)} in __init__.py, but it is in {files}."
    if len(others) == 1:
        right = f"{package}.{others[0].rpartition('/')[2].removesuffix('.py')}"
        cause += f" Write {shorten(right)}."
        fix = at(line(evidence), f"{package}:", f"{right}:")
    return failed(observed, f"{FORM}.", Cause("entry-point-function", cause, line(evidence)).fixed_by(fix))


def _is_top_level(module: Module, call: ast.Call) -> bool:
    """Return whether the call is to rclpy.init or rclpy.spin, and is in a top-level statement of the file.

    Calls inside statements with a block, such as if and try, do not count.
    """
    top = [node for node in module.body if isinstance(node, ast.Expr | ast.Assign)]
    return dotted(call.func) in ("rclpy.init", "rclpy.spin") and any(call in ast.walk(node) for node in top)


def early(evidence: Evidence, _: NoParams) -> Finding | None:
    """Return a failed finding if Python cannot read the module of the entry point in setup.py, else None."""
    setup, files = evidence.setup_py, evidence.submission.files
    point = setup.entry_point(evidence.trial.executable) if setup is not None else None
    file = module_file(point.target.partition(":")[0], files) if point is not None and point.target else None
    unreadable = read_module(file, files[file]).unreadable if file is not None else None
    return None if file is None or unreadable is None else unreadable_finding(file, unreadable, files[file])


def _bindings(module: Module, name: str) -> Iterator[ast.stmt]:
    """Yield the top-level statements (also inside if, try, with and loops) that bind the name."""
    waiting = list(module.body)
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


ENTRY_POINT = Kind(
    "entry_point",
    "build",
    "The entry point names a function",
    NoParams,
    entry_point,
    early=early,
    about="`ros2 run` finds the executable, and its entry point names a function in a module that Python can read.",
)
