"""Run colcon, usually in a sandbox cell. Each `setup.py` usually runs in a fork of a prepared interpreter.

colcon runs the setup.py of a package three times, each time in a new interpreter that imports setuptools and reads the
metadata of all installed packages again. These imports take most of the CPU time of a build. So one process imports the
modules once, before the submission arrives, and forks for each run of setup.py. The fork gets the folder, environment,
arguments and streams of the process that colcon started. That process only waits for the exit code of the fork. If a
fork might behave differently from a new interpreter, no fork is used (`Run.of`).

This file runs as a separate script. Standard input is the submission, a tar stream that is unpacked into src.
"""

from __future__ import annotations

import gc
import importlib.machinery
import json
import os
import re
import signal
import site
import socket
import subprocess
import sys
import types
import warnings
from contextlib import suppress
from dataclasses import asdict, dataclass
from functools import cache, partial
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

# In a cell, the grader consists of this file and the files that it imports.
sys.path[0] = str(Path(__file__).parents[2])
from grader.colcon.entry_points_cache import EntryPoints  # noqa: E402
from grader.colcon.setup_commands import import_commands  # noqa: E402
from grader.common.quick_exit import QuickExit  # noqa: E402

if TYPE_CHECKING:
    from collections.abc import Mapping

READY = b"colcon-is-ready\n"
"""This line is printed before the submission is read. A later error does not count as a fault of the machine."""
_MOST_OPEN = 4096
_MOST_REQUEST = 1024 * 1024
_IGNORE = re.compile(r"ignore:([^:]*)")
_AT_START = re.compile(r"PYTHON(?!PATH$)|LD_|SETUPTOOLS_|DISTUTILS_")
"""Matches environment variables that have an effect only while Python starts or imports setuptools."""
_WITH_PREFIX = ("sysconfig", "distutils.sysconfig")
"""Modules that copy sys.prefix when they are imported."""
_MODULES = tuple(importlib.machinery.all_suffixes())
_CONDITION = "catkin_pkg.condition"


@dataclass(frozen=True)
class Run:
    """Code that a new interpreter would run. `code` is the argument of -c, or the absolute path of a setup.py."""

    code: str
    argv: list[str]
    ignored: list[str]
    """The beginnings of the warning messages that `-W ignore:MESSAGE` suppresses."""
    cwd: str
    env: dict[str, str]

    @classmethod
    def of(cls, command: list[str], cwd: str, env: Mapping[str, str]) -> Run | None:
        """Return the command as a Run, or None if a fork might behave differently from a new interpreter."""
        python, *words = command
        ignored = []
        while words[:1] == ["-W"] and (match := _IGNORE.fullmatch(words[1])):
            ignored.append(match[1])
            del words[:2]
        if python != sys.executable or _at_start(env) != _at_start(os.environ) or _hides_a_module(cwd):
            return None
        if words[:1] == ["-c"] and len(words) == 2:
            return cls(words[1], ["-c"], ignored, cwd, dict(env))
        script = str(Path(cwd, "setup.py"))
        if words[:1] == ["setup.py"] and _compiles(script):
            return cls(script, words, ignored, cwd, dict(env))
        return None


def _at_start(env: Mapping[str, str]) -> dict[str, str]:
    return {key: value for key, value in env.items() if _AT_START.match(key)}


def _hides_a_module(folder: str) -> bool:
    """Return whether the folder shadows a module that is imported or that setup.py may import, or cannot be read."""
    try:
        return any(
            (name := path.name.partition(".")[0]) in sys.modules
            or (name in _can_be_imported() and (path.suffix in _MODULES or (path / "__init__.py").exists()))
            for path in Path(folder).iterdir()
        )
    except OSError:
        return True


@cache
def _can_be_imported() -> frozenset[str]:
    """Return the names of the modules of Python and of the installed packages, except setup.py's own name."""
    found = set(sys.stdlib_module_names)
    for folder in sys.path:
        with suppress(OSError):
            found.update(path.name.partition(".")[0] for path in Path(folder).iterdir())
    return frozenset(found - {"setup"})


def _compiles(script: str) -> bool:
    try:
        compile(Path(script).read_bytes(), script, "exec", dont_inherit=True)
    except (OSError, SyntaxError, ValueError, RecursionError, MemoryError):
        return False
    return True


class Forks:
    """A process that has imported setuptools and forks for each Run. The process exits when its parent exits."""

    def __init__(self) -> None:
        importlib.import_module("setuptools")
        importlib.import_module("distutils.core")
        metadata.entry_points = EntryPoints()
        self._requests, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        if os.fork() == 0:
            self._requests.close()
            import_commands()
            gc.freeze()  # a fork would copy the memory that garbage collection writes to
            become(_next_run(theirs))
        theirs.close()

    def do(self, run: Run) -> None:
        """Execute this run in a fork, and exit with the fork's exit code. If no fork is available, return normally.

        The caller is a process that colcon has started and that would otherwise become a new interpreter.
        """
        try:
            ours, theirs = socket.socketpair()
            socket.send_fds(self._requests, [json.dumps(asdict(run)).encode()], [0, 1, 2, theirs.fileno()])
            theirs.close()
            os.closerange(3, ours.fileno())  # colcon waits until its pipe to this process is closed
            os.closerange(ours.fileno() + 1, _MOST_OPEN)
            status = int(ours.recv(64) or b"-1")
        except OSError:
            return
        if os.WIFSIGNALED(status):
            with suppress(OSError):  # nobody can change the action of SIGKILL
                signal.signal(os.WTERMSIG(status), signal.SIG_DFL)
            os.kill(os.getpid(), os.WTERMSIG(status))
        os._exit(os.WEXITSTATUS(status))


def _next_run(requests: socket.socket) -> Run:
    """Fork this process for each request.

    In the parent process, this function never returns. In a fork, it returns the run to execute.
    """
    while True:
        request, received, _, _ = socket.recv_fds(requests, _MOST_REQUEST, 8)
        if not request:
            os._exit(0)
        child = os.fork()
        if child == 0:
            requests.detach()  # the run may get this number for a file, which the socket must not close
            for number, descriptor in enumerate(received[:3]):
                os.dup2(descriptor, number)
            os.closerange(3, _MOST_OPEN)
            return Run(**json.loads(request))
        with socket.socket(fileno=received[3]) as answer:
            for descriptor in received[:3]:
                os.close(descriptor)
            answer.send(str(os.waitpid(child, 0)[1]).encode())


def become(run: Run) -> NoReturn:
    """Execute the run in this process as in a new interpreter, and exit."""
    os.chdir(run.cwd)
    own = set(_entries(os.environ))
    os.environ.clear()
    os.environ.update(run.env)
    sys.path[:] = [*_entries(run.env), *(entry for entry in sys.path if entry not in own)]
    sys.modules.pop("sitecustomize", None)
    prefix = sys.prefix
    site.execsitecustomize()
    if sys.prefix != prefix:
        for name in _WITH_PREFIX:
            importlib.reload(sys.modules[name])
    sys.warnoptions[:] = [f"ignore:{beginning}" for beginning in run.ignored]
    for beginning in run.ignored:
        warnings.filterwarnings("ignore", re.escape(beginning))
    sys.argv = run.argv
    QuickExit.kept = frozenset(sys.modules) - {"__main__"}
    main, code = _main_of(run)
    sys.path.insert(0, "" if run.argv[0] == "-c" else run.cwd)
    gc.enable()
    try:
        exec(compile(code, getattr(main, "__file__", "<string>"), "exec", dont_inherit=True), main.__dict__)
    except SystemExit as end:
        QuickExit.code = 0 if end.code is None else end.code
        raise
    except BaseException as error:
        trace = error.__traceback__
        # The traceback does not contain the frame of this function.
        sys.excepthook(type(error), error.with_traceback(trace and trace.tb_next), error.__traceback__)
        QuickExit.code = 1
        sys.exit(1)
    QuickExit.code = 0
    sys.exit()


def _main_of(run: Run) -> tuple[types.ModuleType, bytes]:
    """Return the module __main__ of this run, and its source."""
    main = types.ModuleType("__main__")
    main.__dict__.update({name: value for name, value in vars(sys.modules["__main__"]).items() if name[:2] == "__"})
    main.__doc__ = None
    sys.modules["__main__"] = main
    if run.argv[0] == "-c":
        for name in ("__file__", "__cached__"):
            main.__dict__.pop(name, None)
        main.__loader__ = importlib.machinery.BuiltinImporter
        return main, run.code.encode()
    main.__file__ = run.code
    main.__loader__ = importlib.machinery.SourceFileLoader("__main__", run.code)
    return main, Path(run.code).read_bytes()


def _entries(env: Mapping[str, str]) -> list[str]:
    """Return the entries that PYTHONPATH adds to sys.path."""
    path = env.get("PYTHONPATH")
    return list(dict.fromkeys(map(os.path.abspath, path.split(os.pathsep)))) if path else []


def _starting_with(forks: Forks) -> type[subprocess.Popen[Any]]:
    """Return a Popen class that executes setup.py in forks."""

    class Popen(subprocess.Popen[Any]):
        def __init__(self, command: Any, *rest: Any, **options: Any) -> None:  # noqa: ANN401 - as the base class
            cwd, env = str(Path(options.get("cwd") or ".").absolute()), options.get("env") or os.environ
            words = list(map(str, command)) if isinstance(command, list | tuple) else [str(command)]
            run = Run.of(words, cwd, env)
            if run is not None:
                options["preexec_fn"] = partial(forks.do, run)
            super().__init__(command, *rest, **options)

    return Popen


def _evaluate_condition(condition: str | None, context: Mapping[str, str]) -> Any:  # noqa: ANN401 - catkin_pkg's
    """Evaluate a condition as catkin_pkg does, but import the slow parser only if there is a condition."""
    if condition is None:
        return True
    sys.modules.pop(_CONDITION)
    return importlib.import_module(_CONDITION).evaluate_condition(condition, context)


def main() -> None:
    """Unpack the submission into src, and run colcon with the arguments of this process."""
    sys.path.pop(0)
    for name in [name for name in sys.modules if name.partition(".")[0] == "grader"]:
        del sys.modules[name]
    QuickExit.prepare()
    gc.disable()  # imports leave hardly any garbage
    forks = Forks()
    sys.modules[_CONDITION] = types.SimpleNamespace(evaluate_condition=_evaluate_condition)  # type: ignore[assignment]
    colcon = importlib.import_module("colcon_core.command").main
    # If one of these modules failed to load during a build, colcon would skip it, and the package would be blamed.
    for name in ("colcon_core.shell.dsv", "colcon_core.shell.sh", "colcon_core.task.python.build"):
        importlib.import_module(name)
    for name in ("colcon_ros.package_identification.ros", "colcon_ros.task.ament_python.build"):
        importlib.import_module(name)
    os.write(2, READY)
    if subprocess.call(["tar", "-x", "-f", "-", "-C", "src"]):
        sys.exit(90)
    os.dup2(os.open(os.devnull, os.O_RDONLY), 0)
    subprocess.Popen = _starting_with(forks)  # type: ignore[assignment,misc]
    sys.argv[0] = "-c"
    gc.freeze()
    gc.enable()
    code = colcon()
    QuickExit.code = code
    sys.exit(code)


if __name__ == "__main__":
    main()
