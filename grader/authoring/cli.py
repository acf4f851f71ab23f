"""An author's verbs of the command `grader`: release, validate. No logic."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - typer reads the annotations when it runs
from typing import Annotated, Optional

import typer

PANEL = "For authors"


def add_to(app: typer.Typer) -> None:
    """Add these verbs to the command."""
    app.command(epilog="Example: grader release --to ../for-students", rich_help_panel=PANEL)(release)
    app.command(epilog="Example: grader validate 03-circle-publisher", rich_help_panel=PANEL)(validate)


def release(
    check: Annotated[bool, typer.Option("--check", help="Change nothing; fail when exercises/ is stale.")] = False,
    to: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(help="Write the students' repository, without solutions, into this new folder.", metavar="DIR"),
    ] = None,
) -> None:
    """Make exercises/ from solutions/, for authors."""
    from grader.authoring.release import main as make_exercises

    if to:
        from grader.authoring.handout import hand_out

        hand_out(to)
        typer.echo(f"The students' repository: {to}")
        return
    raise typer.Exit(make_exercises(["--check"] if check else []))


def validate(
    exercises: Annotated[list[str] | None, typer.Argument(help="Which ones; all when left out.", metavar="ID")] = None,
) -> None:
    """See whether exercises, solutions, starting points and lessons are as they should be, for authors."""
    from grader.authoring.validate import validate as problems_of
    from grader.report.progress_line import progress

    with progress() as tell:
        problems = problems_of(exercises or [], tell)
    for problem in problems:
        typer.echo(f"- {problem}")
    typer.echo(f"{len(problems)} problems." if problems else "Everything is as it should be.")
    raise typer.Exit(1 if problems else 0)
