"""The verbs of a class with nbgrader: `grader gradebook`, `grader class`, `grader kernel`. No logic."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Optional

import typer

from grader.classroom.cli import PANEL

gradebook = typer.Typer(name="gradebook", help="nbgrader's gradebook.", no_args_is_help=True)
classes = typer.Typer(name="class", help="A class that hands in notebooks.", no_args_is_help=True)
kernel = typer.Typer(name="kernel", help="The course's kernel for Jupyter.", no_args_is_help=True)


def add_to(app: typer.Typer) -> None:
    """Add these verbs to the command."""
    gradebook.command(epilog="Example: grader gradebook sync 03-circle-publisher")(sync)
    gradebook.command(epilog="Example: grader gradebook compare")(compare)
    classes.command(epilog="Example: grader class new ros2-2027 --roster roster.csv")(new)
    kernel.command(epilog="Example: grader kernel install")(install)
    for each in (gradebook, classes, kernel):
        # Without this a group of one verb would be that verb.
        each.callback()(_group)
        app.add_typer(each, rich_help_panel=PANEL)


def _group() -> None:
    """Has nothing to do of its own."""


Steps = Annotated[
    Optional[list[str]],  # noqa: UP045 - typer reads the annotation, and Python 3.10 has to
    typer.Argument(help="Which steps; all that were collected when left out.", metavar="STEP"),
]
Course = Annotated[
    Optional[Path],  # noqa: UP045
    typer.Option(help="The class's folder, or its course/; this one when left out.", metavar="DIR"),
]


def sync(
    steps: Steps = None,
    course: Course = None,
    jobs: Annotated[
        Optional[int],  # noqa: UP045
        typer.Option(min=1, help="How many at once; as many as processors and memory allow when left out."),
    ] = None,
    checks: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(help="A folder of private checks, laid out as course/.", metavar="DIR"),
    ] = None,
    trusted: Annotated[
        bool,
        typer.Option("--trust-submissions", help="Run them where there is no sandbox: on a machine to lose."),
    ] = False,
) -> None:
    """Grade the submitted packages themselves, in parallel, and write the scores into nbgrader's gradebook."""
    from grader.common.words import a_list, count, printable
    from grader.gradebook.folders import open_class
    from grader.gradebook.scores import sync as write
    from grader.report.progress_line import progress

    folders = open_class(course)
    with progress() as tell:
        done = write(folders, steps or [], jobs=jobs, checks=checks, trusted=trusted, say=typer.echo, tell=tell)
    kept = f" {count(done.kept, 'manual grade')} stand." if done.kept else ""
    typer.echo(f"{count(done.changed, 'score')} of {count(done.submissions, 'submission')} changed.{kept}")
    if done.elsewhere:
        typer.echo(f"Not in the gradebook, since no cell of the notebook stands for them: {a_list(done.elsewhere)}.")
    for each in done.unconfirmed:
        which = f" {', '.join(each.checks)}" if each.checks else ""
        typer.echo(printable(f"{each.student} {each.step}{which}: 0 points, needs manual grading: {each.why}."))
    if done.unjudged:
        typer.echo(f"Not judged, for a fault of the machine: {a_list(done.unjudged)}. Run this again.")
        raise typer.Exit(3)


def compare(steps: Steps = None, course: Course = None) -> None:
    """List where the kernel that autograde ran and the grader disagree, and what the grader has not confirmed."""
    from grader.common.words import count, printable
    from grader.gradebook.folders import open_class
    from grader.gradebook.scores import compare as differences_of

    differences = differences_of(open_class(course), steps or [])
    for each in differences:
        kernel_said = "nothing" if each.kernel is None else f"{each.kernel:g}"
        grader_said = f"0, needs manual grading ({each.why})" if each.grader is None else f"{each.grader:g}"
        typer.echo(printable(f"{each.student} {each.step} {each.check}: kernel {kernel_said}, grader {grader_said}"))
    typer.echo(f"{count(len(differences), 'difference')}. What counts is what the grader says, after `sync`.")


def new(
    folder: Annotated[Path, typer.Argument(help="A new folder.", metavar="DIR")],
    roster: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(help="CSV with the column id, and perhaps first_name, last_name, email.", metavar="FILE.csv"),
    ] = None,
) -> None:
    """Make a course folder for a class: lessons, solutions, notebooks, nbgrader's gradebook with the roster."""
    from grader.common.words import count
    from grader.gradebook.class_folder import make_class

    students = make_class(folder, roster)
    typer.echo(f"A class of {count(students, 'student')}: {folder}")
    typer.echo(f"Next: cd {folder / 'course'}; nbgrader generate_assignment 01-first-node")


def install(
    prefix: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(help="For the Jupyter below this folder, instead of all of this user's.", metavar="DIR"),
    ] = None,
) -> None:
    """Make the kernel "ROS 2 Jazzy (course)" known to Jupyter: ROS 2 is there in it, without sourcing anything."""
    from grader.exercise.model import course_folder
    from grader.notebook.kernel import DISPLAY_NAME
    from grader.notebook.kernel import install as install_kernel
    from grader.report.progress_line import progress
    from grader.ros import underlay
    from grader.ros.installation import find_ros

    with progress() as tell:
        # Now, and not while Jupyter waits for the kernel.
        underlay.ensure(find_ros(), tell)
    typer.echo(f'The kernel "{DISPLAY_NAME}": {install_kernel(prefix)}')
    if prefix is None:
        typer.echo(f"\nNext, in {course_folder().parent}: open the first notebook.\n")
        typer.echo("    source .venv/bin/activate")
        typer.echo("    jupyter lab exercises/01-first-node/01-first-node.ipynb")
