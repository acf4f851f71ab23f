"""The learner's commands: start, run, watch, hint, status and solution."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Optional

import typer

from grader.common.terminal_text import say
from grader.exercise.completion import steps as known_steps
from grader.exercise.completion import steps_or_next

PANEL = "Learn"
"""The heading of these commands in --help."""

if TYPE_CHECKING:
    from grader.exercise.model import Exercise

Workspace = Annotated[
    Optional[Path],  # noqa: UP045 - typer reads the annotation, and Python 3.10 has to
    typer.Option(help="Your colcon workspace. Default: $ROS2_WORKSPACE or ~/ros2_ws.", metavar="DIR"),
]
Step = Annotated[
    Optional[str],  # noqa: UP045
    typer.Argument(help="A step, such as 03-circle-publisher or 03.", metavar="STEP", autocompletion=known_steps),
]


def add_to(app: typer.Typer) -> None:
    """Add the learner's commands to the typer application `app`."""
    app.command(rich_help_panel=PANEL, epilog="Example: grader start 01")(start)
    app.command(rich_help_panel=PANEL, epilog="Examples: grader run; grader run 07 draw_square")(run)
    app.command(rich_help_panel=PANEL, epilog="Example: grader watch")(watch)
    app.command(rich_help_panel=PANEL, epilog="Example: grader hint")(hint)
    app.command(rich_help_panel=PANEL, epilog="Example: grader status")(status)
    app.command(rich_help_panel=PANEL, epilog="Example: grader solution 01")(solution)


def start(
    step: Annotated[
        str,
        typer.Argument(
            help="A step, such as 03-circle-publisher or 03, or the word next.",
            metavar="STEP|next",
            autocompletion=steps_or_next,
        ),
    ] = "next",
    workspace: Workspace = None,
    student: Annotated[
        Optional[str],  # noqa: UP045
        typer.Option(help="Your student id. Your numbers in some steps depend on it."),
    ] = None,
    fresh: Annotated[
        bool,
        typer.Option(
            "--fresh", help="Start the step again from its starting point. Your work is moved to another folder."
        ),
    ] = False,
) -> None:
    """Add the files of a step to your workspace. Your own files are not overwritten."""
    from grader.learner import steps

    begun = steps.start(step, workspace, student=student, fresh=fresh)
    say(steps.begin_message(begun), sys.stdout)


def run(
    step: Step = None,
    program: Annotated[
        Optional[str],  # noqa: UP045
        typer.Argument(help="An executable of the step. Default: the first one.", metavar="EXECUTABLE"),
    ] = None,
    workspace: Workspace = None,
    view: Annotated[bool, typer.Option("--view/--no-view", help="Show the turtle on a local web page.")] = True,
) -> None:
    """Build your package and run its node together with a turtlesim that you can watch. Ctrl-C ends both.

    A turtlesim that was already running is not ended.
    """
    from grader.learner import run_node

    raise typer.Exit(run_node.run(run_node.program_of(step, program, workspace), view=view))


def hint(
    step: Step = None,
    part: Annotated[
        Optional[str],  # noqa: UP045
        typer.Argument(help="A part of the step, such as d.", metavar="PART"),
    ] = None,
    workspace: Workspace = None,
) -> None:
    """Show the next hint for a step. The first hints are short, and the last hints almost give the answer away."""
    from grader.learner import hints

    _print(hints.hint(step, workspace, part))


def status(workspace: Workspace = None) -> None:
    """Show your progress."""
    from rich.console import Console

    from grader.learner import steps

    steps.print_status(workspace, Console(highlight=False))


def solution(
    step: Annotated[
        str, typer.Argument(help="A step that you have passed, such as 03.", metavar="STEP", autocompletion=known_steps)
    ],
    workspace: Workspace = None,
) -> None:
    """Show the solution of a step next to your files, once you have passed the step."""
    from rich.console import Console

    from grader.learner.compare import print_solution

    print_solution(step, workspace, Console(highlight=False))


def watch(
    path: Annotated[
        Path | None, typer.Argument(help="Folder of a package, or a step such as 03. Default: your current step.")
    ] = None,
    exercise: Annotated[
        Optional[str],  # noqa: UP045
        typer.Option(help="The exercise, if the folder does not determine it.", autocompletion=known_steps),
    ] = None,
    workspace: Workspace = None,
) -> None:
    """Grade again after every save. Keys: h hint, l list, n next, r rerun, q quit."""
    from grader.learner.watch_screen import run

    run(*place(path, exercise, workspace), workspace)


def _print(text: str) -> None:
    """Print text. Lines are wrapped between words on a terminal, but not in a pipe."""
    from rich.console import Console

    console = Console(highlight=False)
    console.print(text, markup=False, soft_wrap=not console.is_terminal)


def place(path: Path | None, exercise: str | None, workspace: Path | None = None) -> tuple[Exercise, Path]:
    """Return the exercise and the folder that contains the learner's work on the exercise.

    Raises:
        UsageError: the arguments do not determine the exercise, no exercise has that name, or the folder of the step
            does not exist.
        MachineError: the learner's progress cannot be read.
    """
    from grader.learner.exercise_argument import meant

    return meant(path, exercise, workspace)
