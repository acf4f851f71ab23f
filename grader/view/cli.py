"""The command `grader sim`: turtlesim without a workspace."""

from __future__ import annotations

import os
import signal
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Optional

import typer

from grader.common.terminal_text import say

if TYPE_CHECKING:
    from collections.abc import Sequence

PANEL = "Learn"
_WORDS = ("--view", "--view terminal", "--view page", "--image", "--port")
Image = Annotated[
    Optional[Path],  # noqa: UP045 - typer reads the annotation, and Python 3.10 has to
    typer.Option(help="Write the canvas with the turtle's path to a PNG file on exit.", metavar="FILE.png"),
]
Port = Annotated[
    Optional[int],  # noqa: UP045 - as above
    typer.Option(help="Port of the page. Default: the same port as last time, if it is free."),
]


def add_to(app: typer.Typer) -> None:
    """Add the command `grader sim` to the typer application `app`."""
    app.command(
        context_settings={"allow_extra_args": True, "ignore_unknown_options": True},
        epilog="Examples: grader sim --view; grader sim --view terminal",
        rich_help_panel=PANEL,
    )(sim)


def sim(
    context: typer.Context,
    image: Image = None,
    view: Annotated[
        bool,
        typer.Option(
            "--view", help="Show the turtles on a page on this machine, or in this terminal with `--view terminal`."
        ),
    ] = False,
    port: Port = None,
) -> None:
    """Run turtlesim without a window, as a node in wall time, until Ctrl-C. Use --view to see the turtles."""
    from grader.common.interpreter import interpreter
    from grader.report.output_file import check_writable
    from grader.report.progress_line import progress
    from grader.ros.installation import find_ros, users_environment, who_hears
    from grader.ros.underlay import with_turtlesim

    # typer does not support options with an optional value. `App` separates --view=terminal into two words.
    where = context.args.pop(0) if view and context.args[:1] in (["page"], ["terminal"]) else "page"
    refuse_unknown(context.args)
    check_writable(image)
    with progress() as tell:
        ros = with_turtlesim(find_ros(), tell)
    given = [("--image", image), ("--view", where if view else None), ("--port", port)]
    options = [text for name, value in given if value is not None for text in (name, str(value))]
    env = users_environment(ros)
    say(f"turtlesim in {who_hears(env)}. Press Ctrl-C to stop turtlesim.")
    start = interpreter(
        "-m", "grader.view.turtlesim_node", *options, *context.args, python=str(ros.python), env=env, searches=True
    )
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])  # until the program can handle Ctrl-C
    os.execve(start.argv[0], start.argv, start.env)


def refuse_unknown(arguments: Sequence[str]) -> None:
    """Raise UsageError for an argument that is neither an option of the command nor for ROS 2."""
    from grader.common.words import nearest, shorten
    from grader.errors import UsageError

    if not arguments or arguments[0] == "--ros-args":
        return
    guess = nearest(arguments[0], (each for each in _WORDS if each != arguments[0]))
    hint = f" Did you mean {guess}?" if guess else ""
    message = f"`grader sim` has no argument {shorten(arguments[0], 60)}.{hint} `grader sim --help` lists the options."
    if arguments[0].partition("=")[0] == "--domain":
        message = "`grader sim` has no option --domain. `grader shell --domain N` opens a shell with domain N."
    raise UsageError(message)
