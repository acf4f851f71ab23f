"""The command `grader`: its subcommands and their options."""

from __future__ import annotations

import gc
import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Optional

import typer

from grader.authoring import cli as authoring
from grader.book import cli as book
from grader.classroom import cli as classroom
from grader.common.command_help import App
from grader.common.exiting import run_and_exit
from grader.common.interpreter import clean_own
from grader.common.log_commands import protect_output
from grader.common.needed_command import needed_command
from grader.common.own_environment import require_own_environment
from grader.common.own_process import prepare
from grader.common.standard_streams import make_usable
from grader.common.terminal_text import say
from grader.common.updated import updated
from grader.errors import MachineError
from grader.exercise.completion import steps as known_steps
from grader.gradebook import cli as gradebook
from grader.learner import cli as learner
from grader.open import cli as open_course
from grader.setup import cli as setup
from grader.view import cli as view

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.checks.outcome import Outcome
    from grader.evidence.evidence import Evidence
    from grader.evidence.recording_format import Archived
    from grader.exercise.model import Exercise
    from grader.report.report import Report

app = App(
    name="grader",
    help="Grade ROS 2 packages: build them with colcon, run them with a headless turtlesim, and judge what the turtle "
    "did.",
    epilog="Example: grader check exercises/03-circle-publisher",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

LEARN, TEACH = learner.PANEL, classroom.PANEL
# The learner's commands come first in --help.
learner.add_to(app)
open_course.add_to(app)


Json = Annotated[Optional[Path], typer.Option("--json", help="Write the report as JSON.", metavar="FILE")]  # noqa: UP045
Image = Annotated[Optional[Path], typer.Option(help="Draw the turtle's trajectory as a PNG.", metavar="FILE.png")]  # noqa: UP045
Html = Annotated[
    Optional[Path],  # noqa: UP045
    typer.Option("--html", help="Write an HTML page with checks, code, replay, graph and logs.", metavar="FILE.html"),
]
Verbose = Annotated[bool, typer.Option("--verbose", "-v", help="Also print which clock was used, and why.")]
ExerciseId = Annotated[
    Optional[str],  # noqa: UP045 - typer reads the annotation, and Python 3.10 has to
    typer.Option(
        "--exercise",
        help="The id of the exercise. Not required for a folder in exercises/ or solutions/.",
        autocompletion=known_steps,
    ),
]


@app.command(
    rich_help_panel=LEARN,
    epilog="Example: grader check ~/ros2_ws/src/my_robot_controller --exercise 03",
)
def check(
    submission: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Argument(
            help="Folder of a package, a folder that contains one, or a step such as 03. Default: your current step."
        ),
    ] = None,
    exercise: ExerciseId = None,
    clock: Annotated[
        classroom.Clock, typer.Option(help="auto: simulated time, or wall time in doubtful cases.")
    ] = classroom.Clock.auto,
    json: Json = None,
    image: Image = None,
    html: Html = None,
    recording: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(help="Save a recording that `grader regrade` can judge again.", metavar="DIR"),
    ] = None,
    seed: Annotated[
        Optional[int],  # noqa: UP045
        typer.Option(help="Seed for a random start pose of the turtle, and for the other random inputs of the trials."),
    ] = None,
    confined: Annotated[
        bool, typer.Option("--sandbox", help="Run only in a sandbox. By default, the sandbox is used if possible.")
    ] = False,
    explain: Annotated[
        bool,
        typer.Option(
            "--explain",
            help="For instructors: test fixes for the reported causes in a copy of the submission, and show what "
            "was changed.",
        ),
    ] = False,
    verbose: Verbose = False,
) -> None:
    """Build and run one submission, and print what is right and what is wrong."""
    gc.disable()  # a check leaves hardly any garbage, and ends soon
    from functools import partial

    from grader.colcon.shared_builds import build_for
    from grader.evidence import recording_format
    from grader.grading.grade import grade
    from grader.grading.options import Options
    from grader.learner import exercise_argument
    from grader.report.output_file import check_writable
    from grader.report.progress_line import progress
    from grader.report.terminal import early
    from grader.sandbox import bubblewrap
    from grader.trial.trial import Trial

    for file in (json, image, html):
        check_writable(file)
    if recording:
        recording_format.check_free(recording)
    requested, opened = exercise_argument.opened(submission, exercise)
    in_cell = bubblewrap.require(anyway="Without --sandbox, this code runs") if confined else bubblewrap.usable()
    options = Options(in_cell, clock.value, seed, explain)
    with progress() as tell:
        graded = grade(
            requested,
            opened,
            options,
            tell,
            early=lambda failed: tell.keep_all(early(failed)),
            build=build_for(marks=confined),
            trial=partial(Trial, share=not confined),
        )
    from grader.learner import steps

    following, unsaved = "", None
    try:
        following = steps.note(requested, opened.package_dir, graded.report)
    except MachineError as error:  # the verdict comes first
        unsaved = error
    if following and image is None:
        following = "\n".join(filter(None, [steps.keep_picture(graded.evidence, graded.report), following]))
    try:
        _show(graded.report, graded.evidence, json, image, html, verbose=verbose, following=following, changes=explain)
    finally:
        if recording:
            recording_format.save(
                recording, graded.evidence, graded.report.ros, graded.prefixes, confined=graded.report.confined
            )
        if unsaved is not None:
            raise unsaved


@app.command(rich_help_panel=TEACH, epilog="Example: grader regrade my-recording --image path.png")
def regrade(
    recording: Annotated[Path, typer.Argument(help="A folder from `grader check --recording`.", metavar="RECORDING")],
    exercise: Annotated[
        Optional[str],  # noqa: UP045
        typer.Option(
            help="Judge with the current version of this exercise, not with the recorded one.",
            autocompletion=known_steps,
        ),
    ] = None,
    json: Json = None,
    image: Image = None,
    html: Html = None,
    verbose: Verbose = False,
) -> None:
    """Judge a recording again, without running any of the student's code."""
    from grader.checks.exercises import find_exercise, load_exercise
    from grader.report.output_file import check_writable
    from grader.report.report import report_of
    from grader.submission.reader import read

    for file in (json, image, html):
        check_writable(file)
    other = find_exercise(exercise) if exercise else None
    kept, outcomes = read(_judged, recording, (lambda _: other) if other else load_exercise)
    report = report_of(kept.evidence, outcomes, kept.ros, {}, confined=kept.confined)
    _show(report, kept.evidence, json, image, html, verbose=verbose)


@app.command("class-page", rich_help_panel=TEACH, epilog="Example: grader class-page reports")
def class_page(
    folder: Annotated[
        Path, typer.Argument(help="Folder with the reports of a class (from --json), and their pages if there are any.")
    ],
    out: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(help="The page to write. Default: index.html in the folder.", metavar="FILE.html"),
    ] = None,
) -> None:
    """Make a page about a class: points, the most frequent failures, and what to teach again."""
    from grader.report.html_class import PAGE, save_class_page

    file = out or folder / PAGE
    for line in save_class_page(folder, file):
        say(line)
    say(f"The class page: {file}", sys.stdout)


view.add_to(app)
setup.add_to(app)
classroom.add_to(app)
gradebook.add_to(app)
authoring.add_to(app)
book.add_to(app)


def main() -> None:
    """Run the command, and exit."""
    run_and_exit(_run, _explain)


def _run() -> None:
    clean_own()
    make_usable()
    prepare()
    protect_output()
    require_own_environment()
    words = sys.argv[1:]
    if "_GRADER_COMPLETE" in os.environ:  # the shell requests completions (grader.ros.shell)
        from typer.completion import completion_init  # type: ignore[attr-defined]

        completion_init()
        words = []
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # limits numpy's threads, as in grader.ros.installation
    needed_command(app, words)()


def _explain(error: Exception) -> str | None:
    """Return a sentence if the course was updated during this command, or has changed since its set-up."""
    if updated():
        what = f"{type(error).__name__}: {error}"
        return f"the course was updated while this command was running ({what}). Type the command again."
    if not isinstance(error, ImportError):
        return None
    from grader.setup import bootstrap

    return bootstrap.outdated(error)


def _judged(recording: Path, read_exercise: Callable[[Path], Exercise]) -> tuple[Archived, tuple[Outcome, ...]]:
    from grader.checks.judge import judge
    from grader.evidence import recording_format

    kept = recording_format.load(recording, read_exercise)
    return kept, judge(kept.evidence)


def _show(
    report: Report,
    evidence: Evidence,
    json: Path | None,
    image: Path | None,
    html: Path | None,
    *,
    verbose: bool,
    following: str = "",
    changes: bool = False,
) -> None:
    from rich.console import Console

    from grader.report import terminal
    from grader.report.report_files import save_files

    console = Console(highlight=False)
    terminal.render(report, console, verbose=verbose)
    if changes:
        terminal.changes(evidence.tries, console)
    if following:
        console.print(following, soft_wrap=True)
    # The verdict comes first, because these files may be on a disk that is full.
    save_files(evidence, report, json, image, html)
    raise typer.Exit(report.exit_code)


if __name__ == "__main__":
    main()
