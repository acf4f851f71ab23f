"""The command `grader open`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Optional

import typer

PANEL = "Learn"
Workspace = Annotated[
    Optional[Path],  # noqa: UP045 - typer reads the annotation, and Python 3.10 has to
    typer.Option(help="Your colcon workspace. Default: $ROS2_WORKSPACE or ~/ros2_ws.", metavar="DIR"),
]
Port = Annotated[
    Optional[int],  # noqa: UP045 - as above
    typer.Option(help="Port of the page. Default: the same port as last time, if it is free."),
]


def add_to(app: typer.Typer) -> None:
    """Add the command `grader open` to the typer application `app`."""
    app.command("open", rich_help_panel=PANEL, epilog="Example: grader open")(open_page)


def open_page(
    workspace: Workspace = None,
    port: Port = None,
    show: Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page in your browser.")] = True,
) -> None:
    """Open a page with the lesson, the verdict after each save, and a live turtle. Ctrl-C ends the command."""
    from grader.open.course_page import run

    run(workspace, port, opens=show)
