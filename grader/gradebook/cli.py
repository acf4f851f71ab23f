"""The commands `grader gradebook`, `grader class` and `grader kernel`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Optional

import typer

from grader.classroom.cli import PANEL
from grader.common.command_help import App

gradebook = App(name="gradebook", help="Grade a class that uses nbgrader, and compare scores.", no_args_is_help=True)
classes = App(name="class", help="Create a class that uses nbgrader.", no_args_is_help=True)
kernel = App(name="kernel", help="Install the course's kernel for Jupyter.", no_args_is_help=True)


def add_to(app: typer.Typer) -> None:
    """Add the commands for nbgrader, classes and kernels to the typer application `app`."""
    gradebook.command(epilog="Example: grader gradebook sync 03-circle-publisher")(sync)
    gradebook.command(epilog="Example: grader gradebook compare")(compare)
    classes.command(epilog="Example: grader class new ros2-2027 --roster roster.csv")(new)
    kernel.command(epilog="Example: grader kernel install")(install)
    for each in (gradebook, classes, kernel):
        # Without a callback, typer turns a group with one command into that command.
        each.callback()(_group)
        app.add_typer(each, rich_help_panel=PANEL)


def _group() -> None:
    """Do nothing. The library typer requires such a callback."""


Steps = Annotated[
    Optional[list[str]],  # noqa: UP045 - typer reads the annotation, and Python 3.10 has to
    typer.Argument(help="Steps. Default: all collected steps.", metavar="STEP"),
]
Course = Annotated[
    Optional[Path],  # noqa: UP045
    typer.Option(
        help="Folder of the class or its course/. Default: the current folder, if it is this course or your class.",
        metavar="DIR",
    ),
]


def sync(
    steps: Steps = None,
    course: Course = None,
    jobs: Annotated[
        Optional[int],  # noqa: UP045
        typer.Option(
            min=1, help="Number of submissions to grade in parallel. Default: as many as processors and memory allow."
        ),
    ] = None,
    checks: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(help="Folder with private checks, laid out like course/.", metavar="DIR"),
    ] = None,
    trusted: Annotated[
        bool,
        typer.Option(
            "--trust-submissions",
            help="Run submissions even without a sandbox. Use this only on a machine without important data.",
        ),
    ] = False,
) -> None:
    """Grade the submitted packages in parallel and write the scores into nbgrader's gradebook."""
    from grader.common.words import a_list, count, printable
    from grader.gradebook.class_folders import open_class
    from grader.gradebook.scores import sync as write
    from grader.report.progress_line import progress

    folders = open_class(course)
    with progress() as tell:
        done = write(folders, steps or [], jobs=jobs, checks=checks, trusted=trusted, say=typer.echo, tell=tell)
    kept = f" {count(done.kept, 'manual grade')} kept." if done.kept else ""
    typer.echo(f"{count(done.changed, 'score')} of {count(done.submissions, 'submission')} changed.{kept}")
    if done.elsewhere:
        typer.echo(
            f"Checks without a cell in the notebook, whose points are not in the gradebook: {a_list(done.elsewhere)}."
        )
    for reason in done.left_out:
        typer.echo(printable(f"Not graded: {reason}"))
    if done.maxima:
        typer.echo(f"Changed maximum points in the gradebook: {a_list(done.maxima)}.")
    for each in done.unconfirmed:
        which = f" {', '.join(each.checks)}" if each.checks else ""
        typer.echo(printable(f"{each.student} {each.step}{which}: 0 points, needs manual grading: {each.why}."))
    if done.unjudged:
        unjudged = printable(a_list(done.unjudged))
        typer.echo(f"Could not be judged: {unjudged}. Run this command again.")
        raise typer.Exit(3)


def compare(steps: Steps = None, course: Course = None) -> None:
    """List scores on which autograde's kernel and the grader disagree, and scores that are not confirmed."""
    from grader.common.words import a_list, count, printable
    from grader.gradebook.class_folders import open_class
    from grader.gradebook.differences import compare as compared

    done = compared(open_class(course), steps or [])
    if done.not_synced:
        typer.echo(
            f"The grader has not graded the submissions of {a_list(done.not_synced)} yet. First type: "
            f"grader gradebook sync {' '.join(done.not_synced)}"
        )
    elif not done.synced:
        of_steps = f" of {a_list(steps)}" if steps else ""
        typer.echo(f"The gradebook has no submissions{of_steps} yet. First type `nbgrader autograde STEP` for a step.")
    if not done.synced:
        return
    for each in done.differences:
        kernel_said = "nothing" if each.kernel is None else f"{each.kernel:g}"
        grader_said = f"0, needs manual grading ({each.why})" if each.grader is None else f"{each.grader:g}"
        typer.echo(printable(f"{each.student} {each.step} {each.check}: kernel {kernel_said}, grader {grader_said}"))
    differ = count(len(done.differences), "difference")
    typer.echo(f"{differ}. After `sync`, the grader's score counts. A manual grade stays.")


def new(
    folder: Annotated[Path, typer.Argument(help="A new folder.", metavar="DIR")],
    roster: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(help="CSV with the column id and optionally first_name, last_name and email.", metavar="FILE.csv"),
    ] = None,
) -> None:
    """Create a course folder for a class, with lessons, solutions, notebooks and nbgrader's gradebook."""
    from grader.common.words import count
    from grader.gradebook.class_folders import remember
    from grader.gradebook.new_class import make_class

    made = make_class(folder, roster)
    remember(folder)
    typer.echo(f"A class of {count(made.students, 'student')}: {folder}")
    typer.echo(f"The course in nbgrader's exchange: {made.course_id}")
    typer.echo(f"Next: cd {folder / 'course'}; nbgrader generate_assignment 01-first-node")


def install(
    prefix: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(
            help="Install the kernel for the Jupyter installation with this prefix. Default: for the current user.",
            metavar="DIR",
        ),
    ] = None,
) -> None:
    """Install the Jupyter kernel "ROS 2 Jazzy (course)", which works without sourcing ROS 2."""
    from grader.exercise.model import course_folder
    from grader.notebook.kernel import DISPLAY_NAME
    from grader.notebook.kernel import install as install_kernel
    from grader.report.progress_line import progress
    from grader.ros import underlay
    from grader.ros.installation import find_ros

    with progress() as tell:
        # Build the interfaces now, so that Jupyter does not have to wait for them.
        underlay.ensure(find_ros(), tell)
    typer.echo(f'The kernel "{DISPLAY_NAME}": {install_kernel(prefix)}')
    if prefix is None:
        typer.echo(f"\nNext, in {course_folder().parent}: open the first notebook.\n")
        typer.echo("    source .venv/bin/activate")
        typer.echo("    jupyter lab exercises/01-first-node/01-first-node.ipynb")
