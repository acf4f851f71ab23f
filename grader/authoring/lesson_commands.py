"""Check the commands in the console and shell blocks of a lesson without running them.

Each command line of `grader`, `ros2` or `colcon` is parsed by the parser of this command: the subcommand and the
options must exist. If a command of `grader` contains the name of a step, this step must exist in the course. If a
command is `ros2 run`, the step's solution or the course's turtlesim must have the executable.
"""

from __future__ import annotations

import re
import shlex
from typing import TYPE_CHECKING, Any, NoReturn

import typer
from typer.core import TyperGroup
from typer.exceptions import TyperException

from grader.authoring.console_blocks import blocks
from grader.authoring.parse_colcon import colcon_faults
from grader.authoring.solution_programs import Programs, programs_of, why_not_started
from grader.common.words import a_list
from grader.errors import GraderError
from grader.exercise.model import catalogue
from grader.ros.failure import did_you_mean
from grader.ros2 import unsupported
from grader.ros2.parser import Parser, invalid_choice, make_parser

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

SHELLS = ("bash", "sh")
"""The languages of blocks in which each line is a command."""
STEPS = ("step", "steps", "exercise", "exercises")
"""The parameters of the commands of `grader` whose values are steps."""
_BEFORE = ("if", "then", "else", "while", "until", "do", "!", "time", "exec")
"""Shell keywords that can come before a command."""
_SET = re.compile(r"[A-Za-z_]\w*=.*", re.DOTALL)
_HELP = ("-h", "--help")


def command_problems(markdown: str, course: Path, app: typer.Typer, step: str | None = None) -> Iterator[str]:
    """Yield a sentence for each invalid command in the console and shell blocks.

    `course` is the folder course/, and `app` is the command `grader`. `step` is the step of a lesson; without it,
    `ros2 run` may start the executables of all steps.
    """
    programs = programs_of(course, step)
    of_colcon: list[tuple[str, list[str]]] = []
    for line in _lines(markdown):
        try:
            commands = simple_commands(line)
        except ValueError as error:
            yield f"`{line}` cannot be read by a shell: {error}."
            continue
        for name, *words in commands:
            if name == "colcon":
                of_colcon.append((line, words))
            fault = _grader_fault(words, course, app) if name == "grader" else _ros2_fault(words, name, programs)
            if fault:
                yield _sentence(line, fault)
    faults = colcon_faults([words for _, words in of_colcon]) if of_colcon else []
    yield from (_sentence(line, _brief(fault)) for (line, _), fault in zip(of_colcon, faults, strict=True) if fault)


def _sentence(line: str, fault: str) -> str:
    return f"`{line}` is not a valid command: {fault.rstrip('.')}{'' if fault.endswith('?') else '.'}"


def _lines(markdown: str) -> Iterator[str]:
    """Yield the command lines. A line that ends with a backslash continues on the next line."""
    for block in blocks(markdown):
        prompt = "$ " if block.language == "console" else ""
        if not prompt and block.language not in SHELLS:
            continue
        for line in re.sub(r"\\\n(> )?", " ", block.text).splitlines():
            if line.startswith(prompt) and line.strip():
                yield line.removeprefix(prompt).strip()


def simple_commands(line: str) -> list[list[str]]:
    """Return the words of each command in a shell command line, without assignments, redirections and keywords.

    Raises ValueError if a quotation mark is missing.

    Example:
        >>> simple_commands('cd ~/ros2_ws && ROS_DOMAIN_ID=3 ros2 topic list > "a b" | head')
        [['cd', '~/ros2_ws'], ['ros2', 'topic', 'list'], ['head']]
    """
    lexer = shlex.shlex(line, posix=True, punctuation_chars=True)
    lexer.whitespace_split = True
    commands: list[list[str]] = [[]]
    skip = False
    for word in lexer:
        if not word or set(word) - set("();<>|&"):
            begins = not commands[-1] and (word in _BEFORE or _SET.fullmatch(word))
            commands[-1] += [] if skip or begins else [word]
            skip = False
        elif set(word) & set("<>") and "(" not in word:
            skip = True  # the next word is the name of a file
        else:
            commands.append([])
    return [words for words in commands if words]


def _grader_fault(words: Sequence[str], course: Path, app: typer.Typer) -> str:
    command: Any = typer.main.get_command(app)
    context: Any = None
    name: str | None = "grader"
    rest = [word for word in words if word not in _HELP]
    asks_for_help = len(rest) < len(words)
    try:
        while isinstance(command, TyperGroup) and rest:
            context = typer.Context(command, parent=context, info_name=name)
            name, command, rest = command.resolve_command(context, rest)
        if isinstance(command, TyperGroup) or asks_for_help:
            return ""
        context = command.make_context(name, rest, parent=context)
    except (TyperException, GraderError) as error:
        return str(error)
    missing = list(_missing_steps(context, course))
    return f"the course has no step {a_list(missing, 'or')}." if missing else ""


def _missing_steps(context: Any, course: Path) -> Iterator[str]:  # noqa: ANN401 - typer's Context
    known = list(catalogue(course))
    for name, value in context.params.items():
        given = [str(each) for each in (value if isinstance(value, list | tuple) else [value]) if each is not None]
        for each in given:
            number = f"{int(each):02}" if each.isascii() and each.isdigit() else each
            is_step = name in STEPS or (name in ("path", "submission") and each.isdigit())
            if is_step and each != "next" and not any(step.startswith(number) for step in known):
                yield each


class _Strict(Parser):
    """A parser that raises ValueError instead of printing an error message."""

    def error(self, message: str) -> NoReturn:
        """Raise the error message as a ValueError."""
        raise ValueError(_brief(message))


def _brief(message: str) -> str:
    """Return an error message of argparse on one line, without the list of all choices."""
    invalid = invalid_choice(message)
    text = did_you_mean(*invalid, f"there is no {invalid[0]}.") if invalid else message
    return " ".join(text.split())


def _ros2_fault(words: Sequence[str], name: str, programs: Programs) -> str:
    if name != "ros2" or set(words) & set(_HELP):
        return ""
    try:
        parsed = make_parser(words, _Strict).parse_args(words)
    except ValueError as error:
        return "" if "does not exist" in str(error) else str(error)  # a lesson's bag exists only after its commands
    if parsed.run is unsupported.run:
        return "the course's ros2 does not support it."
    executable = getattr(parsed, "executable_name", None)
    return why_not_started(parsed.package_name, executable, programs) if executable else ""
