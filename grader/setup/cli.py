"""The commands `grader doctor`, `grader env` and `grader shell`."""

from __future__ import annotations

import sys
from typing import Annotated, Optional

import typer

from grader.errors import GraderError

PANEL = "Your machine"


def add_to(app: typer.Typer) -> None:
    """Add `grader doctor`, `grader env` and `grader shell` to the typer application `app`."""
    app.command(epilog="Example: source <(grader env)", rich_help_panel=PANEL)(env)
    app.command(epilog="Example: grader shell --domain 7", rich_help_panel=PANEL)(shell)
    app.command(epilog="Example: grader doctor", rich_help_panel=PANEL)(doctor)


def doctor() -> None:
    """Check whether this machine can grade (ROS 2, colcon, compiler, sandbox), and print what to do if it cannot."""
    from rich.console import Console

    from grader.report.progress_line import progress
    from grader.setup.doctor import exit_code, render, run_doctor

    with progress() as tell:
        lines = run_doctor(tell=tell)
    render(lines, Console(highlight=False))
    raise typer.Exit(exit_code(lines))


Domain = Annotated[
    Optional[int],  # noqa: UP045
    typer.Option(
        help="ROS domain, 0 to 101. Default: ROS_DOMAIN_ID. If it is not set: 0 with a sourced ROS 2, else a domain of "
        "your own."
    ),
]


def env(domain: Domain = None) -> None:
    """Print shell code that adds ROS 2 to this shell. Type `source <(grader env)` in bash or zsh."""
    from grader.report.progress_line import progress
    from grader.ros import shell
    from grader.ros.installation import find_ros, who_hears

    try:
        with progress() as tell:
            wanted = shell.users_environment(domain, tell)
    except GraderError:
        # A shell that sources this output does not get the exit code.
        print("false")
        raise
    ros = find_ros()
    if ros.kind == "sourced":
        used = f"Using the ROS 2 that is sourced in this terminal: {ros.prefix}"
        print(f"{used} ({who_hears(wanted)})", file=sys.stderr)
    sys.stdout.write(shell.code(wanted, sourced=ros.kind == "sourced"))


def shell(domain: Domain = None) -> None:
    """Open a shell with ROS 2. Type exit to leave the shell."""
    from grader.report.progress_line import progress
    from grader.ros import shell as shells
    from grader.ros.installation import who_hears

    with progress() as tell:
        wanted = shells.users_environment(domain, tell)
    print(f"This shell has ROS 2, in {who_hears(wanted)}. Type exit to leave this shell.")
    sys.stdout.flush()
    shells.open_shell(wanted)
