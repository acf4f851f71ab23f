"""Run the node of a step with a turtlesim and its view.

Ctrl-C stops both, but not a turtlesim that was already running.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager, nullcontext, suppress
from dataclasses import dataclass
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING

from grader.checks.exercises import load_exercise
from grader.common.how_ended import program_ended
from grader.common.interpreter import interpreter
from grader.common.temporary_folder import temporary_folder
from grader.common.terminal_text import say
from grader.common.words import nearest
from grader.errors import MachineError, UsageError
from grader.exercise.model import catalogue
from grader.learner.exercise_argument import meant

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from grader.exercise.model import Exercise

READY_S = 120.0
"""The maximum time for starting turtlesim (s), which is long enough for a busy machine."""
ENDS_S = 10.0
"""The maximum time for a program to exit after Ctrl-C (s). After this time, the program is killed. On a busy machine, a
node may take several seconds to leave the graph."""


@dataclass(frozen=True)
class Program:
    """The program to run: the folder and name of the package, and the executable."""

    folder: Path
    package: str
    executable: str


def program_of(step: str | None, executable: str | None, workspace: Path | None) -> Program:
    """Return the program to run. The defaults are the current step and the first program of the step.

    Raises:
        UsageError: no step was named or started, the step does not exist, has no folder in the workspace, has no node,
            or does not run this executable.
        MachineError: the learner's progress cannot be read.
    """
    if step and executable is None and not Path(step).exists():
        _refuse_program_as_step(step)
    advice = f"Type `grader run STEP{_workspace_option(Path(step)) if step else ''}`"
    exercise, place = meant(Path(step) if step else None, None, workspace, advice=advice)
    names = executables(exercise)
    if not names:
        message = f"{exercise.id} has no node to run. `grader sim --view` starts turtlesim without a node."
        raise UsageError(message)
    name = executable or names[0]
    if name not in names:
        guess = nearest(name, names)
        hint = f" Did you mean {guess}?" if guess else ""
        message = f"{exercise.id} has no program {name}.{hint} Its programs: {', '.join(names)}."
        raise UsageError(message)
    inside = place / exercise.package
    folder = inside if (inside / "package.xml").is_file() else place
    return Program(folder.resolve(), exercise.package, name)


def _workspace_option(path: Path) -> str:
    """Return the option for the workspace that contains the package in `path`, or an empty string.

    `path` is the folder of the package, the folder src, or the workspace.
    """
    given = path.resolve()
    for root in (given, given.parent, given.parent.parent):
        if given in (root, root / "src", *(root / "src").glob("*")) and any(root.glob("src/*/package.xml")):
            return f" --workspace {quote(str(root))}"
    return ""


def _refuse_program_as_step(name: str) -> None:
    """Raise UsageError if the name is the name of a program and not of a step."""
    if name.isdigit() or any(each.startswith(name) for each in catalogue()):
        return
    owner = next((each for each, file in catalogue().items() if name in executables(load_exercise(file))), None)
    if owner:
        message = f"{name} is a program, not a step. Type: grader run {owner[:2]} {name}"
        raise UsageError(message)


def executables(exercise: Exercise) -> list[str]:
    """Return the names of the executables of the exercise's nodes, without duplicates.

    A program that a trial calls, such as `bag_report` in step 11, is not a node.
    """
    return list(dict.fromkeys(trial.executable for trial in exercise.trials if trial.executable and not trial.calls))


def run(program: Program, *, view: bool) -> int:
    """Build the package, and run the program with a turtlesim until Ctrl-C or until the program exits.

    If a turtlesim is already running, the program uses it. Otherwise, `run` starts a turtlesim, with a page that shows
    the turtle if `view` is true. The output of the node, and of a build that failed, appears on the terminal. Return 0
    if the node runs until Ctrl-C or exits without an error, and 1 otherwise.

    Raises:
        UsageError: ROS_DOMAIN_ID is not a valid domain id.
        MachineError: ROS 2 or turtlesim cannot be started.
    """
    from grader.ros import shell

    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, _interrupt)
    env = shell.users_environment(None, _tell)
    with temporary_folder() as place:
        _tell(f"Building {program.package}")
        overlay = _built(program, place, env)
        if overlay is None:
            return 1
        script = overlay / "lib" / program.package / program.executable
        if not script.is_file():
            say(f"\n{no_executable(program)}")
            return 1
        beside = _beside_another(env)
        with nullcontext() if beside else _turtlesim(env, view=view):
            ended = "the program" if beside else "the program and turtlesim"
            say(f"{program.executable} is running. Press Ctrl-C to stop {ended}.\n")
            return _until_it_ends(program, script, _with_overlay(env, overlay, program.folder))


def no_package(program: Program) -> str:
    """Return the message for a build in which colcon reported no error but did not build the program's package."""
    name = f"<name>{program.package}</name>"
    return f"colcon found no package {program.package} in {program.folder}. The package.xml in it must contain {name}."


def no_executable(program: Program) -> str:
    """Return the message for a package that was built but has no such program in lib/PACKAGE."""
    return (
        f"The package has no executable {program.executable} in lib/{program.package}. See the list console_scripts in "
        f"{program.folder / 'setup.py'}, and the folders in setup.cfg."
    )


def _built(program: Program, place: Path, env: Mapping[str, str]) -> Path | None:
    """Build with colcon outside the workspace. Return install/<package>, or None if the package was not built."""
    bases = ["--build-base", str(place / "build"), "--install-base", str(place / "install")]
    # The user's settings of colcon, such as `symlink-install` in ~/.colcon/defaults.yaml, are for the workspace.
    own = {name: value for name, value in env.items() if not name.startswith("COLCON_")}
    colcon = interpreter(
        *("-c", "import sys; from colcon_core.command import main; sys.exit(main())"),
        *("--log-base", str(place / "log"), "build", "--base-paths", str(program.folder), *bases),
        *(
            "--event-handlers",
            "console_direct+",
            "console_start_end-",
            "console_stderr-",
            "summary-",
        ),
        env={**own, "COLCON_HOME": str(place / "colcon")},
        searches=True,
    )
    done = subprocess.run(
        colcon.argv, cwd=place, env=colcon.env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False
    )
    overlay = place / "install" / program.package
    if done.returncode == 0 and overlay.is_dir():
        return overlay
    print(done.stdout.rstrip(), file=sys.stderr)
    failed = "The package could not be built. See the messages of colcon above."
    say(f"\n{failed if done.returncode else no_package(program)}")
    return None


def _with_overlay(env: Mapping[str, str], overlay: Path, folder: Path) -> dict[str, str]:
    """Return the environment in which the package is found, as after `source install/setup.bash`."""
    modules = next(overlay.glob("lib/python3*/site-packages"), overlay)
    # The learner's own folder comes first, so that a traceback names the learner's files and not copies of them.
    own = [str(folder)] if (modules / overlay.name).is_dir() else []

    def first(name: str, *paths: str) -> str:
        return os.pathsep.join(filter(None, [*paths, env.get(name, "")]))

    return {
        **env,
        "AMENT_PREFIX_PATH": first("AMENT_PREFIX_PATH", str(overlay)),
        "PYTHONPATH": first("PYTHONPATH", *own, str(modules)),
        "ROS_PYTHON_CHECK_FIELDS": "1",
        "PYTHONDONTWRITEBYTECODE": "1",
    }


def turtle_is_there(env: Mapping[str, str]) -> bool:
    """Return whether a turtlesim is already running, for example `grader sim --view` in another terminal."""
    start = interpreter("-m", "grader.ros2.main", "node", "list", env=env, searches=True)
    listed = subprocess.run(start.argv, env=start.env, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=False)
    return b"/turtlesim" in listed.stdout.split()


def _beside_another(env: Mapping[str, str]) -> bool:
    there = turtle_is_there(env)
    if there:
        say("A turtlesim is already running, and the node uses it.")
    return there


@contextmanager
def _turtlesim(env: Mapping[str, str], *, view: bool) -> Iterator[None]:
    """Run turtlesim, and stop it at the end of the `with` block.

    Raises:
        MachineError: turtlesim did not start within READY_S. Its output has been printed.
    """
    options = ["--view"] if view else []
    with temporary_folder() as place:
        log = place / "log"
        with log.open("wb") as writing:
            start = interpreter("-m", "grader.view.turtlesim_node", *options, env=env, searches=True)
            simulator = subprocess.Popen(
                start.argv, env=start.env, stderr=writing, start_new_session=True, stdin=subprocess.DEVNULL
            )
        try:
            begun = time.monotonic()
            while b"Spawning turtle" not in log.read_bytes():
                if simulator.poll() is not None or time.monotonic() - begun > READY_S:
                    print(log.read_text("utf-8", "replace").rstrip(), file=sys.stderr)
                    message = "turtlesim did not start. `grader doctor` checks the machine."
                    raise MachineError(message)
                time.sleep(0.02)
            yield
        finally:
            _end(simulator)


def _until_it_ends(program: Program, script: Path, env: Mapping[str, str]) -> int:
    start = interpreter(str(script), env=env, searches=True)
    node = subprocess.Popen(start.argv, env=start.env)
    interrupted = False
    while True:
        try:
            code = node.wait(ENDS_S if interrupted else None)
            break
        except KeyboardInterrupt as stop:
            if isinstance(stop, _Signalled) or not sys.stdin.isatty():  # a terminal also sends Ctrl-C to the node
                node.send_signal(signal.SIGINT)
            interrupted = True
        except subprocess.TimeoutExpired:
            say(f"\n{program.executable} did not end after Ctrl-C, so it was killed.")
            node.kill()
    if interrupted:
        return 0
    say(program_ended(program.executable, code))
    return 0 if code == 0 else 1


class _Signalled(KeyboardInterrupt):
    """SIGTERM or SIGHUP has arrived. Unlike Ctrl-C in a terminal, it may not have reached the node."""


def _interrupt(*_: object) -> None:
    raise _Signalled


def _end(process: subprocess.Popen[bytes]) -> None:
    with suppress(ProcessLookupError):
        process.send_signal(signal.SIGINT)
    try:
        process.wait(ENDS_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()


def _tell(text: str) -> None:
    say(f"{text} ...")
