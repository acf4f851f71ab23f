"""The instructor's commands: `grader grade` and `grader gradescope build`."""

from __future__ import annotations

from enum import Enum
from pathlib import Path
from typing import Annotated, Optional

import typer

from grader.common.command_help import App
from grader.common.terminal_text import say
from grader.errors import UsageError
from grader.exercise.completion import steps as known_steps

PANEL = "Teach"
"""The heading of these commands in --help."""

gradescope = App(name="gradescope", help="Create an autograder for Gradescope.", no_args_is_help=True)


class Clock(str, Enum):
    """The clock for the trials of a submission."""

    auto = "auto"
    simulated = "simulated"
    wall = "wall"


def add_to(app: typer.Typer) -> None:
    """Add `grader grade` and `grader gradescope build` to the typer application `app`."""
    app.command(
        rich_help_panel=PANEL,
        epilog="Example: grader grade submitted --exercise 03-circle-publisher --out grades",
    )(grade)
    gradescope.command(
        rich_help_panel=PANEL, epilog="Example: grader gradescope build 03-circle-publisher autograder.zip"
    )(build)
    app.add_typer(gradescope, rich_help_panel=PANEL)


def grade(
    submissions: Annotated[
        list[Path],
        typer.Argument(
            help=(
                "A folder with one folder or archive (.zip, .tar.gz) per student, nbgrader's submitted/, "
                "or a folder of clones of the students' repositories."
            )
        ),
    ],
    exercise: Annotated[
        Optional[str],  # noqa: UP045 - typer reads the annotation, and Python 3.10 has to
        typer.Option(
            help="The id of the exercise. Not required for nbgrader's submitted/.",
            metavar="ID",
            autocompletion=known_steps,
        ),
    ] = None,
    jobs: Annotated[
        Optional[int],  # noqa: UP045
        typer.Option(
            min=1,
            help="Number of submissions to grade in parallel. Default: as many as processors and memory allow.",
            metavar="N",
        ),
    ] = None,
    engine: Annotated[
        str,
        typer.Option(help="Grade on this machine (local) or with Dask (dask://HOST:PORT).", metavar="ENGINE"),
    ] = "local",
    out: Annotated[
        Path,
        typer.Option(
            help="Folder for the results. Submissions with a valid result in this folder are not graded again.",
            metavar="DIR",
        ),
    ] = Path("grades"),
    fail_under: Annotated[
        Optional[float],  # noqa: UP045
        typer.Option(min=0, max=100, help="Exit with code 1 if a submission gets less than N percent.", metavar="N"),
    ] = None,
    checks: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(
            help="Folder with your own hidden checks, laid out like course/.",
            metavar="DIR",
            exists=True,
            file_okay=False,
        ),
    ] = None,
    roster: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(
            help="CSV with the columns submission and student, for submissions that are not named after student ids.",
            metavar="FILE.csv",
        ),
    ] = None,
    clock: Annotated[
        Clock,
        typer.Option(
            help="auto, simulated or wall. auto: simulated time, or wall time in doubtful cases.", metavar="CLOCK"
        ),
    ] = Clock.auto,
    seed: Annotated[
        Optional[int],  # noqa: UP045
        typer.Option(help="Seed for a random start pose of the turtle, and for the other random inputs of the trials."),
    ] = None,
    explain: Annotated[
        bool,
        typer.Option(
            "--explain/--no-explain",
            help="Prove the causes of failed checks: test fixes for the causes in a copy of the submission. "
            "For a failed submission, this takes up to 1.5 times as long as a build and a run.",
        ),
    ] = True,
    trusted: Annotated[
        bool,
        typer.Option(
            "--trust-submissions",
            help="Run submissions even without a sandbox. Submissions can then read and change all files of your user.",
        ),
    ] = False,
    repository_folder: Annotated[
        str, typer.Option(help="Path of the package in the repository, for GitHub's annotations.", metavar="PATH")
    ] = "",
) -> None:
    """Grade a class, several submissions in parallel. After an interruption, the same command continues the grading."""
    from grader.classroom.grade_class import Request, exit_code, grade_class

    request = Request(
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
        explain=explain,
        repository_folder=repository_folder,
    )
    try:
        graded = grade_class(request, typer.echo, lambda text: typer.echo(f"{text} ...", err=True))
    except KeyboardInterrupt:
        say(f"\nStopped. The results so far are in {out}. Run the same command again to continue.")
        raise
    typer.echo(f"Marks: {out / 'summary.csv'}\nThe class: {out / 'index.html'}")
    raise typer.Exit(exit_code(graded, fail_under))


def build(
    exercise: Annotated[str, typer.Argument(help="The exercise.", metavar="ID", autocompletion=known_steps)],
    file: Annotated[Path, typer.Argument(help="Archive to write.", metavar="FILE.zip")] = Path("autograder.zip"),
    checks: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(
            help="Folder with your own hidden checks, laid out like course/.",
            metavar="DIR",
            exists=True,
            file_okay=False,
        ),
    ] = None,
    trusted: Annotated[
        bool,
        typer.Option(
            "--trust-submissions",
            help="Run submissions even if Gradescope does not allow sandboxes. A submission could then change its own "
            "mark.",
        ),
    ] = False,
) -> None:
    """Create the archive to upload to Gradescope as an autograder."""
    from grader.classroom.gradescope_archive import build_archive
    from grader.report.output_file import check_writable

    if file.is_dir() or file.suffix != ".zip":
        message = f"{file} is a folder, or does not end in .zip. Choose another name that ends in .zip."
        raise UsageError(message)
    check_writable(file)
    build_archive(exercise, file, checks, trusted=trusted)
    typer.echo(f"Upload {file} to Gradescope: open your assignment, then Configure Autograder.")
