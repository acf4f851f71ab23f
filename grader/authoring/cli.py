"""The author's commands: `grader release` and `grader validate`."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - typer reads the annotations when it runs
from typing import Annotated, Optional

import typer

PANEL = "For authors"


def add_to(app: typer.Typer) -> None:
    """Add `grader release` and `grader validate` to the typer application `app`."""
    app.command(epilog="Example: grader release --to ../for-students", rich_help_panel=PANEL)(release)

    @app.command(epilog="Example: grader validate 03-circle-publisher", rich_help_panel=PANEL)
    def validate(
        exercises: Annotated[
            list[str] | None, typer.Argument(help="Exercises to validate. Default: all.", metavar="ID")
        ] = None,
    ) -> None:
        """Check exercises, solutions, starting points and lessons (for authors)."""
        _validate(exercises or [], app)


def release(
    check: Annotated[
        bool, typer.Option("--check", help="Change nothing, and exit with code 1 if a file is out of date.")
    ] = False,
    to: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(help="Write the repository for students, without solutions, to this new folder.", metavar="DIR"),
    ] = None,
) -> None:
    """Create exercises/ from solutions/ (for authors)."""
    from grader.authoring.release import main as make_exercises

    if to:
        from grader.authoring.handout import hand_out

        hand_out(to)
        typer.echo(f"The students' repository: {to}")
        return
    raise typer.Exit(make_exercises(["--check"] if check else []))


def _validate(exercises: list[str], app: typer.Typer) -> None:
    from grader.authoring.validate import validate as problems_of
    from grader.common.words import count
    from grader.report.progress_line import progress

    with progress() as tell:
        problems = problems_of(exercises, app, tell)
    for problem in problems:
        typer.echo(f"- {problem}")
    typer.echo(f"{count(len(problems), 'problem')}." if problems else "No problems found.")
    raise typer.Exit(1 if problems else 0)
