"""Explain why the executable of the exercise does not exist, for example because its name in setup.py is misspelt."""

from __future__ import annotations

import ast
import re
import tokenize
from typing import TYPE_CHECKING

from grader.checks.cause import Cause
from grader.checks.causes.bad_entry_point import bad_entry_point, is_joined
from grader.checks.edit import at
from grader.checks.outcome import Finding, failed
from grader.common.words import nearest, shorten
from grader.submission.code import module_file, read_code
from grader.submission.package_xml import line_of
from grader.submission.tokens import tokens
from grader.submission.where import Where

if TYPE_CHECKING:
    from grader.evidence.evidence import Evidence
    from grader.submission.code import Module
    from grader.submission.setup_py import EntryPoint, SetupPy

FORM = "An entry point has the form NAME = PACKAGE.MODULE:FUNCTION in the list console_scripts of setup.py"

MISSPELT = 0.84
"""Names with at least this difflib ratio count as misspellings of each other. draw_star and draw_square have 0.8."""


def line(evidence: Evidence) -> Where:
    """Return the line of setup.py with the entry point, or else with `console_scripts`, or else with setup()."""
    setup = evidence.setup_py
    if setup is None:
        return Where("setup.py")
    point = setup.entry_point(evidence.trial.executable)
    if point is not None:
        return Where("setup.py", point.line)
    listed = line_of(evidence.submission.files.get("setup.py", b""), r"[\"']console_scripts\b")
    return Where("setup.py", listed or setup.setup_line)


def indented(module: Module | None, name: str) -> Cause | None:
    """Return the cause if the module has the function inside another statement, such as a class, else None."""
    functions = [node for node in module.nodes if isinstance(node, ast.FunctionDef)] if module is not None else []
    inside = next((node for node in functions if node.name == name and node.col_offset), None)
    if module is None or inside is None:
        return None
    text = f"{shorten(name)} is indented, so it belongs to {_outer(module, inside)}. Remove the indentation."
    return Cause("main-in-class", text, Where(module.file, inside.lineno))


def _outer(module: Module, inside: ast.FunctionDef) -> str:
    outer = next(node for node in module.nodes if any(child is inside for child in ast.iter_child_nodes(node)))
    if isinstance(outer, ast.ClassDef):
        return "the class above it"
    if isinstance(outer, ast.FunctionDef | ast.AsyncFunctionDef):
        return f"the function {shorten(outer.name)} above it"
    # A case of a match statement has no line of its own, but its pattern has.
    line = outer.pattern.lineno if isinstance(outer, ast.match_case) else getattr(outer, "lineno", inside.lineno)
    return f"the block that begins on line {line}"


def no_entry_point(evidence: Evidence) -> Finding:
    """Return a failed finding about an executable that was not installed as an entry point."""
    executable, setup = evidence.trial.executable, evidence.setup_py
    expected = f"{FORM}. NAME is {executable}."
    points = (setup.entry_points if setup is not None else None) or ()
    joined = next((point for point in points if is_joined(point)), None)
    if joined is not None:
        return bad_entry_point(joined)
    observed = f"The package has no executable {executable}."
    if executable in evidence.built.executables:
        observed = f"The executable {executable} is not an entry point."
    cause = _unread(evidence, setup) or _script(evidence)
    if cause is None:
        others = sorted(set(evidence.built.entry_points) | set(evidence.built.executables))
        guess = nearest(executable, [other for other in others if not _is_another(evidence, other)])
        if guess is not None:
            where = next((Where("setup.py", point.line) for point in points if point.name == guess), line(evidence))
            text = "Compare the two names letter by letter. The name of an entry point is the part before the = sign."
            observed = f"There is no executable {executable}, but there is {shorten(guess)}."
            why = Cause("entry-point-name", text, where).fixed_by(at(where, guess, executable))
            return failed(observed, expected, why)
        cause = _missing(evidence, points)
    return failed(observed, expected, cause.at(line(evidence)))


def _is_another(evidence: Evidence, name: str) -> bool:
    """Return whether this executable cannot be the executable of the exercise with a wrong name.

    If its name differs from the name of its file, it can be. If the two names are equal, as with draw_circle, it can be
    only if both of these are true:
    - No file has the name of the exercise's executable.
    - The names of the two executables are similar, or one contains the other, or the file of this executable contains
      the name of the exercise's node.
    """
    executable, node = evidence.trial.executable, evidence.trial.node
    has_file = any(path.rpartition("/")[2] == f"{executable}.py" for path in evidence.submission.files)
    module = evidence.built.entry_points.get(name, "").partition(":")[0].strip()
    file = module_file(module, evidence.submission.files)
    source = evidence.submission.files[file] if file is not None else b""
    renamed = name in executable or executable in name or nearest(executable, [name], MISSPELT) is not None
    renamed = renamed or (node is not None and re.search(rf"(['\"]){re.escape(node)}\1".encode(), source) is not None)
    return name == executable or (module.rpartition(".")[2] == name and (has_file or not renamed))


def _script(evidence: Evidence) -> Cause | None:
    """Return the cause if the executable is a script instead of an entry point, else None."""
    executable = evidence.trial.executable
    if executable not in evidence.built.executables:
        return None
    files = evidence.submission.files
    names = (executable, f"{executable}.py")
    found = [path for name in names for path in sorted(files) if path.rpartition("/")[2] == name]
    script = next(iter(found), None)
    if script is None:
        return None
    first = files[script].partition(b"\n")[0].decode("utf-8", "replace")
    if not (first.startswith("#!") and "python" in first and not first.endswith("\r")):
        windows = "has a Windows line ending and " if first.endswith("\r") else ""
        text = f'{script} is installed as a script, and its first line, "{shorten(first, 40)}", '
        text += f"{windows}does not start Python."
        return Cause("script-shebang", text, Where(script, 1))
    text = f"{script} is installed as a script. Use an entry point that names a function in a module."
    return Cause("script-for-entry-point", text, Where(script, 1))


def _unread(evidence: Evidence, setup: SetupPy | None) -> Cause | None:
    """Return the cause if setup.py has the entry point in a comment, in another group or in another list, else None."""
    executable = evidence.trial.executable
    if setup is None:
        return None
    comment = _comment(evidence.submission.files.get("setup.py", b""), executable)
    if comment is not None:
        text = "The entry point is in a comment. Python ignores everything after #."
        return Cause("entry-point-commented", text, Where("setup.py", comment))
    stray = next((point for point in setup.stray if point.name == executable), None)
    if setup.groups and "console_scripts" not in setup.groups:
        text = (
            f'entry_points has the group "{shorten(setup.groups[0])}". Executables belong in the group console_scripts.'
        )
        source = evidence.submission.files["setup.py"]
        group = line_of(source, rf"['\"]{re.escape(setup.groups[0])}['\"]")
        return Cause("entry-point-group", text, Where("setup.py", group) if group is not None else None)
    if stray is not None:
        text = "The entry point is not in the list console_scripts."
        return Cause("entry-point-elsewhere", text, Where("setup.py", stray.line))
    return None


def _comment(source: bytes, executable: str) -> int | None:
    """Return the line of a comment that names the executable before an = sign, or None."""
    for token in tokens(source):
        words = token.string.lstrip("# \"'").partition("=")
        if token.type == tokenize.COMMENT and words[1] and words[0].strip() == executable:
            return token.start[0]
    return None


def _missing(evidence: Evidence, points: tuple[EntryPoint, ...]) -> Cause:
    executable, files = evidence.trial.executable, evidence.submission.files
    if any(point.name == executable for point in points):
        text = "setup.py contains this entry point, but the build did not install it."
        return Cause("entry-point-missing", text)
    for point in points:
        file = module_file((point.target or "").partition(":")[0], files)
        if file is not None and file.rpartition("/")[2] == f"{executable}.py":
            text = (
                f"The entry point of {file} has a different name, {shorten(point.name)}. The name of an entry point is "
                "the part before the = sign."
            )
            where = Where("setup.py", point.line)
            return Cause("entry-point-name", text, where).fixed_by(at(where, point.name, executable))
    file = evidence.node_file or _looks_like_a_node(evidence, [point.target for point in points])
    if file is not None:
        text = f"{shorten(file)} exists, but setup.py has no entry point for it."
        return Cause("entry-point-missing", text)
    return Cause("entry-point-missing", "setup.py has no entry point with this name.")


def _looks_like_a_node(evidence: Evidence, targets: list[str | None]) -> str | None:
    """Return a file that creates a publisher but to which no entry point refers, or None."""
    taken = [module_file((target or "").partition(":")[0], evidence.submission.files) for target in targets]
    everything = read_code(evidence.submission.files, first=None)
    files = [call.module.file for call in everything.calls("create_publisher")]
    return next((file for file in files if file not in taken), None)
