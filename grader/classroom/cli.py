"""The instructor's verbs of the command `grader`: grade, gradescope build. No logic."""

from __future__ import annotations

from enum import Enum
from pathlib import Path
from typing import Annotated, Optional

import typer

from grader.errors import UsageError

PANEL = "Teach"
"""The heading in --help."""

gradescope = typer.Typer(name="gradescope", help="Grade with Gradescope.", no_args_is_help=True)


class Clock(str, Enum):
    """Which clock judges."""

    auto = "auto"
    simulated = "simulated"
    wall = "wall"


def add_to(app: typer.Typer) -> None:
    """Add these verbs to the command."""
    app.command(
        rich_help_panel=PANEL,
        epilog="Example: grader grade submitted --exercise 03-circle-publisher --out grades  (then open "
        "grades/summary.csv)",
    )(grade)
    gradescope.command(
        rich_help_panel=PANEL, epilog="Example: grader gradescope build 03-circle-publisher autograder.zip"
    )(build)
    app.add_typer(gradescope, rich_help_panel=PANEL)


def grade(
    submissions: Annotated[
        list[Path],
        typer.Argument(
            help="A folder with a folder or an archive (.zip, .tar.gz) of each student; nbgrader's submitted/; or a "
            "folder of classroom clones."
        ),
    ],
    exercise: Annotated[
        Optional[str],  # noqa: UP045 - typer reads the annotation, and Python 3.10 has to
        typer.Option(help="Which exercise; in nbgrader's tree it follows from the folder.", metavar="ID"),
    ] = None,
    jobs: Annotated[
        Optional[int],  # noqa: UP045
        typer.Option(min=1, help="How many at once; as many as processors and memory allow when left out."),
    ] = None,
    engine: Annotated[
        str, typer.Option(help="local, or Dask's scheduler: dask://HOST:PORT.", metavar="local|dask://HOST:PORT")
    ] = "local",
    out: Annotated[
        Path, typer.Option(help="Where the results go; what stands there is not graded again.", metavar="DIR")
    ] = Path("grades"),
    fail_under: Annotated[
        Optional[float],  # noqa: UP045
        typer.Option(min=0, max=100, help="Exit code 1 if any submission gets less than so many percent.", metavar="N"),
    ] = None,
    checks: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(help="Your own hidden checks, laid out as course/.", metavar="DIR", exists=True, file_okay=False),
    ] = None,
    roster: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(
            help="A CSV with the columns submission and student, where folders are not called after students' ids.",
            metavar="FILE.csv",
        ),
    ] = None,
    clock: Annotated[
        Clock, typer.Option(help="auto: simulated time, and wall time where that may misjudge.")
    ] = Clock.auto,
    seed: Annotated[Optional[int], typer.Option(help="Start the turtle at a place drawn from this number.")] = None,  # noqa: UP045
    trusted: Annotated[
        bool,
        typer.Option(
            "--trust-submissions", help="Run them even where there is no sandbox: all of this user's is theirs."
        ),
    ] = False,
    repository_folder: Annotated[
        str, typer.Option(help="Where the package is in a repository, for GitHub's annotations.", metavar="PATH")
    ] = "",
) -> None:
    """Grade a class: every submission, several at once; stopped and started again it goes on where it was."""
    from grader.classroom.grade_class import Asked, exit_code, grade_class

    asked = Asked(
        submissions,
        out,
        exercise,
        jobs,
        engine,
        checks,
        roster,
        clock.value,
        seed,
        trusted=trusted,
        repository_folder=repository_folder,
    )
    try:
        graded = grade_class(asked, typer.echo, lambda text: typer.echo(f"{text} ...", err=True))
    except KeyboardInterrupt:
        typer.echo(f"\nStopped. What was graded is in {out}, and the same command goes on from there.", err=True)
        raise
    typer.echo(f"Marks: {out / 'summary.csv'}\nThe class: {out / 'index.html'}")
    raise typer.Exit(exit_code(graded, fail_under))


def build(
    exercise: Annotated[str, typer.Argument(help="Which exercise.", metavar="ID")],
    file: Annotated[Path, typer.Argument(help="The archive to write.", metavar="FILE.zip")] = Path("autograder.zip"),
    checks: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(help="Your own hidden checks, laid out as course/.", metavar="DIR", exists=True, file_okay=False),
    ] = None,
    trusted: Annotated[
        bool,
        typer.Option(
            "--trust-submissions",
            help="Run submissions even where Gradescope allows no sandbox: one could then write its own mark.",
        ),
    ] = False,
) -> None:
    """Make the archive that Gradescope takes as an autograder."""
    from grader.classroom.gradescope import build_archive

    if file.is_dir() or file.suffix != ".zip":
        message = f"{file}: name a file that ends in .zip."
        raise UsageError(message)
    build_archive(exercise, file, checks, trusted=trusted)
    typer.echo(f"Upload {file} at Gradescope: your assignment, Configure Autograder.")
