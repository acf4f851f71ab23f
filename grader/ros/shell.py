"""A shell with ROS 2: the code that `grader env` prints, and the shell that `grader shell` opens."""

from __future__ import annotations

import os
import shlex
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common.interpreter import OF_ANOTHER_PYTHON
from grader.errors import MachineError, UsageError
from grader.ros import installation, underlay

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

HIGHEST_DOMAIN = 101
COMMANDS = ("ros2", "rqt", "rqt_console", "rqt_graph", "rqt_plot")
"""The commands of ROS 2 that the shell can complete, in addition to `grader`."""


def users_environment(
    domain: int | None, tell: Callable[[str], None], env: Mapping[str, str] = os.environ
) -> dict[str, str]:
    """Return the user's environment with ROS 2 added. Build the turtlesim interfaces first if necessary.

    Raises:
        UsageError: the domain id is too large or negative, or ROS_DOMAIN_ID is not a valid domain id.
        MachineError: ROS 2 was not found, turtlesim could not be built, or no folder for logs could be created.
    """
    if domain is not None and not 0 <= domain <= HIGHEST_DOMAIN:
        message = f"--domain takes a whole number from 0 to {HIGHEST_DOMAIN}, not {domain}."
        raise UsageError(message)
    ros = underlay.with_turtlesim(installation.find_ros(env), tell)
    return installation.users_environment(ros, env, domain)


def code(wanted: Mapping[str, str], env: Mapping[str, str] = os.environ, *, sourced: bool = False) -> str:
    """Return shell code for bash, zsh and sh that sets the variables in `wanted` that have other values in `env`.

    The code also unsets variables that were set for another Python. In bash and zsh, it sets up completion for the
    commands of the course.

    `sourced` is True if the ROS 2 installation is a sourced one, which can have its own rqt_graph.
    """
    lines = [f"# For `source <(grader env)`: ROS 2 Jazzy, in domain {wanted['ROS_DOMAIN_ID'] or 0}."]
    lines += [f"export {name}={shlex.quote(value)}" for name, value in wanted.items() if env.get(name) != value]
    lines += [
        # With PYTHONHOME of another Python, the `python3` of .venv would not start, so unset it, as `activate` of a
        # venv does. With the properties of another Python, colcon fails.
        " ".join(["unset PYTHONHOME", *OF_ANOTHER_PYTHON]),
        # zsh cannot complete words before its own completion system has been initialized.
        'if [ -n "${ZSH_VERSION-}" ]; then',
        "  whence compdef > /dev/null || { autoload -Uz compinit && compinit -u; }",
        "fi",
        # A sourced ROS 2 completes its own `ros2`.
        'if [ -n "${ZSH_VERSION-}" ] || { [ -n "${BASH_VERSION-}" ] && ! complete -p ros2 > /dev/null 2>&1; }; then',
        f"  eval {shlex.quote(_completion(COMMANDS))}",
        f'elif [ -n "${{BASH_VERSION-}}" ]; then eval {shlex.quote(_completion(COMMANDS[1:]))}; fi',
        f'if [ -n "${{ZSH_VERSION-}}" ]; then eval {shlex.quote(_completion_of_grader("zsh"))}',
        f'elif [ -n "${{BASH_VERSION-}}" ]; then eval {shlex.quote(_completion_of_grader("bash"))}; fi',
    ]
    if sourced:
        # A sourced ROS 2 may have an rqt_graph that is first on PATH and does not support --text and --output.
        lines.append(f'rqt_graph() {{ {shlex.quote(str(Path(sys.prefix, "bin/rqt_graph")))} "$@"; }}')
    return "\n".join(lines) + "\n"


def open_shell(wanted: Mapping[str, str], env: Mapping[str, str] = os.environ) -> None:
    """Replace this process with the user's shell, or with /bin/bash if SHELL is not set.

    bash and zsh set up the ROS 2 environment, with the domain id in `wanted`, after they have read their start-up
    files. Other shells only get the environment `wanted`.

    Raises:
        MachineError: the shell could not be started.
    """
    shell = env.get("SHELL") or "/bin/bash"
    argv, variables = [shell, "-i"], {}
    # Run our code after the start-up files, because they may set PATH or source a ROS 2.
    ours = f"export ROS_DOMAIN_ID={shlex.quote(wanted['ROS_DOMAIN_ID'])}\n"
    ours += f'eval "$({shlex.quote(str(Path(sys.prefix, "bin/grader")))} env)"\n'
    if Path(shell).name == "bash":
        argv = [shell, "--rcfile", _start_up(f"[ -f ~/.bashrc ] && . ~/.bashrc\n{ours}", "bashrc"), "-i"]
    elif Path(shell).name == "zsh":
        own = env.get("ZDOTDIR", env.get("HOME", "/"))
        text = f'ZDOTDIR={shlex.quote(own)}\n[ -f "$ZDOTDIR/.zshrc" ] && . "$ZDOTDIR/.zshrc"\n{ours}'
        variables = {"ZDOTDIR": str(Path(_start_up(text, ".zshrc")).parent)}
    try:
        os.execvpe(shell, argv, {**wanted, **variables})
    except OSError as error:
        message = f"Your shell, {shell}, could not be started: {error.strerror}. The variable SHELL chooses the shell."
        raise MachineError(message) from error


def _start_up(text: str, name: str) -> str:
    """Write a start-up file, and return its path. When a shell reads the file, the file and its folder are removed."""
    file = Path(tempfile.mkdtemp(prefix="grader-shell-"), name)
    file.write_text(f"rm -rf {shlex.quote(str(file.parent))}\n{text}", encoding="utf-8")
    return str(file)


def _completion_of_grader(shell: str) -> str:
    from typer.completion import get_completion_script  # type: ignore[attr-defined]

    return get_completion_script(prog_name="grader", complete_var="_GRADER_COMPLETE", shell=shell)


def _completion(commands: Sequence[str]) -> str:
    from argcomplete.shell_integration import shellcode

    made: str = shellcode(list(commands), shell="bash")
    return made
