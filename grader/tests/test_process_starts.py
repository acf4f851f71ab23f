"""The list of functions that start a process is complete, and interpreter() starts every Python process."""

from __future__ import annotations

import ast
import os
import re
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parents[2]
GRADER = ROOT / "grader"
DOORS = ("interpreter", "interpreter.interpreter", "_start")
STARTS = {
    "subprocess": {"run", "Popen", "call", "check_call", "check_output", "getoutput", "getstatusoutput"},
    "os": {name for name in dir(os) if re.match(r"exec[lv]|spawn|posix_spawn|fork|system$|popen$", name)},
    "pty": {"spawn", "fork"},
    "runpy": {"run_module", "run_path"},
    "asyncio": {"create_subprocess_exec", "create_subprocess_shell"},
    "multiprocessing": {"Process", "Pool", "Manager", "get_context"},
    "concurrent.futures": {"ProcessPoolExecutor"},
    "pexpect": {"spawn", "run"},
}
OTHERS = {
    ("provide", "_quietly"): "sudo, to check whether it asks for a password",
    ("provide", "_run"): "the package manager",
    ("browser", "_started"): "xdg-open, or the command of interpreter(): the caller passes command and environment",
    ("child", "run_child"): "ros2 run: a program of the user",
    ("create", "_email"): "git",
    ("cell_calls", "_called"): "a fork that calls student code, in its cell",
    ("cells", "run_below"): "our command ros2, or the command of simulator._command",
    ("doctor", "_version_of"): "a compiler, make or cmake, in the system's folder for temporary files",
    ("node_test", "why_not_heard"): "sh, with the commands of _talker_and_listener",
    ("grade", "_alone"): "our command grader",
    ("grade", "start"): "a command of interpreter() in the same function",
    ("kernel", "_source_and_start_again"): "bash, which sources a ROS 2 and executes the command of interpreter()",
    ("cell_sockets", "main"): "the launcher, in its cell, with the command of linked_cell",
    ("linked_cell", "linked_cell"): "bubblewrap, with a command of interpreter() in the same function",
    ("in_cell", "__init__"): "a fork, in its cell",
    ("in_cell", "_next_run"): "a fork that runs setup.py, in its cell",
    ("in_cell", "main"): "tar, in its cell",
    ("install", "_run"): "uv, or the pip command of _pip",
    ("lane", "_start"): "bubblewrap, with a command of interpreter() in the same function",
    ("launcher", "run"): "a student's node that is not Python, in its cell",
    ("lock", "_compile"): "uv, in the course's folder",
    ("measure", "cost"): "the command that a benchmark measures",
    ("fork_client", "_started"): "the loader of Python, with a command of interpreter() in the same function",
    ("forking", "fork_supervised"): "a worker, or a fork that enters a room or a cell",
    ("fork_server", "_next_node"): "a fork that supervises a node",
    ("forking", "_forked"): "a fork that supervises a worker, a conductor or the nodes of a trial",
    ("holder", "__init__"): "bubblewrap, with the command of the caller",
    ("launchers", "__init__"): "the command of conductor._launcher",
    ("notebooks", "seconds"): "the command of the nested function `nbgrader`",
    ("programs", "_start"): "a command of interpreter() in the same function",
    ("open_page", "_screen"): "our command grader",
    ("process", "run"): "bubblewrap, with the command of colcon.runner.build",
    ("relay", "run"): "bubblewrap, with the command of gradebook.confined_autograde._order",
    ("ros2", "_measure"): "our command ros2",
    ("ros2", "main"): "our command ros2",
    ("reading", "main"): "our command grader",
    ("reader", "_fork"): "a fork that only reads",
    ("bubblewrap", "why_unavailable"): "bubblewrap and `true`",
    ("session", "_serve"): "a fork that enters a cell",
    ("session", "_supervise"): "a fork that runs a student's tests, in its cell",
    ("shell", "open_shell"): "the user's shell",
    ("simulator", "start"): "a node of the user, with the command of _command",
    ("startup", "hand_over"): "the real ros2, for the user",
    ("underlay", "_run"): "cmake and a command of interpreter(), in our own folder",
    ("watch", "seconds_to_verdict"): "our command grader",
}
"""Functions that start something other than the `argv` of interpreter(), each with a description of that thing."""
NAMED = {
    ("doctor", "look_at_node"): "printed",
    ("doctor", "look_at_python"): "printed",
    ("in_cell", "of"): "compared with the command that colcon starts",
    ("install", "_uv"): "an argument of uv: where to install",
    ("interpreter", "interpreter"): "interpreter() itself",
    ("bootstrap", "look"): "the version of a sourced Python",
    ("predicted", "predict"): "the first line of a predicted script",
    ("machine", "for_ros"): "the version of a sourced Python",
    ("installation", "users_environment"): "for the setup.bash of a workspace, in the user's shell",
    ("notebooks", "seconds"): "its folder, for PATH",
    ("installation", "environment"): "its folder, for PATH",
    ("underlay", "_build"): "an argument of cmake, which starts it in our own folder",
    ("underlay", "_key_of_sources"): "part of a key",
}
"""Maps a function that uses an interpreter's path, but not as an argument of interpreter(), to the reason."""


def sources() -> Iterator[tuple[Path, ast.Module]]:
    for path in sorted(GRADER.rglob("*.py")):
        if "tests" not in path.relative_to(GRADER).parts:
            yield path, ast.parse(path.read_text("utf-8"))


def in_functions(tree: ast.AST, function: str = "") -> Iterator[tuple[str, ast.AST]]:
    """Yield every node with the name of the function around it."""
    for node in ast.iter_child_nodes(tree):
        inner = node.name if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) else function
        yield inner, node
        yield from in_functions(node, inner)


def process_starts(tree: ast.Module) -> Iterator[tuple[str, ast.Call]]:
    """Yield the calls that start a process, even if their module was imported under another name."""
    names: dict[str, str] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.asname or alias.name: alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names |= {alias.asname or alias.name: f"{node.module}.{alias.name}" for alias in node.names}
    for function, node in in_functions(tree):
        if isinstance(node, ast.Call):
            first, dot, rest = ast.unparse(node.func).partition(".")
            module, _, attribute = f"{names.get(first, first)}{dot}{rest}".rpartition(".")
            if attribute in STARTS.get(module, ()):
                yield function, node


def is_made_by_the_door(call: ast.Call, tree: ast.Module) -> bool:
    """Return whether the command is `NAME.argv`, where interpreter() returned NAME."""
    assigned = [node for node in ast.walk(tree) if isinstance(node, ast.Assign) and isinstance(node.value, ast.Call)]
    made = {
        ast.unparse(node.targets[0])
        for node in assigned
        if isinstance(node.value, ast.Call) and ast.unparse(node.value.func) in DOORS
    }
    command = ast.unparse(call.args[0]) if call.args else ""
    match = re.fullmatch(r"(\w+)\.argv(?:\[0\])?", command)
    return match is not None and match[1] in made


def test_every_process_start_is_known_or_made_by_the_door() -> None:
    others = {
        (path.stem, function): f"{path.relative_to(ROOT)}, {function}: {ast.unparse(call)[:80]}"
        for path, tree in sources()
        for function, call in process_starts(tree)
        if not is_made_by_the_door(call, tree)
    }
    unknown = [reported for where, reported in others.items() if where not in OTHERS]
    assert (unknown, OTHERS.keys() - others.keys()) == ([], set()), (
        "see common/interpreter.py, or add a description here"
    )


def test_no_other_place_names_an_interpreter() -> None:
    named = {
        (path.stem, function): f"{path.relative_to(ROOT)}, {function}: {ast.unparse(node)}"
        for path, tree in sources()
        for function, node in in_functions(tree)
        if names_an_interpreter(node) and not is_harmless(node, tree)
    }
    unknown = [reported for where, reported in named.items() if where not in NAMED]
    assert (unknown, NAMED.keys() - named.keys()) == ([], set())


def names_an_interpreter(node: ast.AST) -> bool:
    """Return whether the expression is `sys.executable` or the attribute `python` of a `Ros` object."""
    return isinstance(node, ast.Attribute) and ast.unparse(node) in ("sys.executable", "here.python", "ros.python")


def is_harmless(node: ast.AST, tree: ast.Module) -> bool:
    """Return whether the expression is harmless.

    It is assigned to `python`, is passed to interpreter() or a Ros object, or only locates our own commands.
    """
    for outer in ast.walk(tree):
        if isinstance(outer, ast.Assign) and ast.unparse(outer.targets[0]) == "python" and node in ast.walk(outer):
            return True
        if isinstance(outer, ast.Call) and any(node is inner for inner in ast.walk(outer)):
            text = ast.unparse(outer)
            if ast.unparse(outer.func) in (*DOORS, "Ros"):
                return any(word.arg == "python" and node in list(ast.walk(word)) for word in outer.keywords)
            if text.endswith(("with_name('grader')", "with_name('ros2')")):
                return True
    return False


NEW = ("subprocess.run([sys.executable, '-m', 'x'])", "from os import execv\nexecv('/x', [])", "run(['python3'])")


@pytest.mark.parametrize("code", NEW)
def test_a_new_process_start_would_be_found(code: str) -> None:
    tree = ast.parse(f"import sys, subprocess\nfrom subprocess import run\ndef function():\n    pass\n{code}")
    assert [is_made_by_the_door(call, tree) for _, call in process_starts(tree)] == [False]


IN_THE_COURSES_FOLDER = {"-Es -m grader.setup.bootstrap", "-EsB -X", "-m pytest"}
"""For machines without an installation, and for developers: the course is the current folder."""


def test_scripts_and_workflows_start_python_isolated() -> None:
    files = [ROOT / "Makefile", *(ROOT / ".ci").iterdir(), *(ROOT / ".github").rglob("*.yml")]
    files += [path for path in (GRADER / "classroom/templates").iterdir() if path.is_file()]
    found = [
        f"{path.name}: {line.strip()}"
        for path in files
        for line in path.read_text("utf-8").splitlines()
        if not line.lstrip().startswith("#")
        for match in re.finditer(r"python3? (-\S*(?: -m \S+| \S+)?)", line)
        if match[1] not in IN_THE_COURSES_FOLDER and not match[1].startswith("-I")
    ]
    assert found == []
