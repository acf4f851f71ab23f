"""The command `grader`: what its verbs take, and which part of the grader does them. No logic."""

from __future__ import annotations

import os
import sys
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Optional

import typer

from grader.authoring import cli as authoring
from grader.classroom import cli as classroom
from grader.common.interpreter import clean_own
from grader.common.refusal import refusal
from grader.errors import GraderError
from grader.gradebook import cli as gradebook
from grader.learner import cli as learner
from grader.setup import cli as setup
from grader.view import cli as view

if TYPE_CHECKING:
    from collections.abc import Callable

    from grader.checks.outcome import Outcome
    from grader.evidence.archive import Archived
    from grader.evidence.evidence import Evidence
    from grader.exercise.model import Exercise
    from grader.report.report import Report
    from grader.submission.package import Submission

app = typer.Typer(
    name="grader",
    help="Grade ROS 2 packages by running them: built with colcon, run against a headless turtlesim, judged by what "
    "the turtle did.",
    epilog="Example: grader check exercises/03-circle-publisher",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

LEARN, TEACH = learner.PANEL, classroom.PANEL
# The learner's verbs stand first in --help.
learner.add_to(app)


class Clock(str, Enum):
    """Which clock judges."""

    auto = "auto"
    simulated = "simulated"
    wall = "wall"


Json = Annotated[Optional[Path], typer.Option("--json", help="Write the report as JSON.", metavar="FILE")]  # noqa: UP045
Image = Annotated[Optional[Path], typer.Option(help="Draw the turtle's path as a PNG.", metavar="FILE.png")]  # noqa: UP045
Html = Annotated[
    Optional[Path],  # noqa: UP045
    typer.Option("--html", help="Write a page to look at: checks, code, replay, graph, logs.", metavar="FILE.html"),
]
Verbose = Annotated[bool, typer.Option("--verbose", "-v", help="Also tell which clock judged, and why.")]
ExerciseId = Annotated[
    Optional[str],  # noqa: UP045 - typer reads the annotation, and Python 3.10 has to
    typer.Option("--exercise", help="Which exercise; in exercises/ and solutions/ it follows from the folder."),
]


@app.command(
    rich_help_panel=LEARN,
    epilog="Example: grader check ~/ros2_ws/src/my_robot_controller --exercise 03-circle-publisher",
)
def check(
    submission: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Argument(
            help="A package's folder, a folder with one below it, or a step, as in 03; your current step when left out."
        ),
    ] = None,
    exercise: ExerciseId = None,
    clock: Annotated[
        Clock, typer.Option(help="auto: simulated time, and wall time where that may misjudge.")
    ] = Clock.auto,
    json: Json = None,
    image: Image = None,
    html: Html = None,
    recording: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(help="Keep all that was seen, to judge it again with `grader regrade`.", metavar="DIR"),
    ] = None,
    seed: Annotated[Optional[int], typer.Option(help="Start the turtle at a place drawn from this number.")] = None,  # noqa: UP045
    confined: Annotated[
        bool, typer.Option("--sandbox", help="Run nothing unless it is confined; else that is done where it can be.")
    ] = False,
    verbose: Verbose = False,
) -> None:
    """Build and run one submission, and say what is right and what is not."""
    from grader.evidence import archive
    from grader.grading.grade import grade
    from grader.grading.options import Options
    from grader.report.files import check_writable
    from grader.report.progress_line import progress
    from grader.report.terminal import early
    from grader.sandbox import bubblewrap

    for file in (json, image, html):
        check_writable(file)
    if recording:
        archive.check_free(recording)
    asked, opened = _opened(submission, exercise)
    options = Options(in_cell=bubblewrap.require() if confined else bubblewrap.usable(), clock=clock.value, seed=seed)
    with progress() as tell:
        graded = grade(asked, opened, options, tell, early=lambda failed: tell.keep_all(early(failed)))
        if recording:
            archive.save(recording, graded.evidence, graded.report.ros, graded.prefixes)
    from grader.learner import steps

    following = steps.note(asked, opened.package_dir, graded.report)
    _show(graded.report, graded.evidence, json, image, html, verbose=verbose, following=following)


@app.command(rich_help_panel=TEACH, epilog="Example: grader regrade my-recording --image path.png")
def regrade(
    recording: Annotated[Path, typer.Argument(help="What `grader check --recording` wrote.", metavar="RECORDING")],
    exercise: Annotated[
        Optional[str],  # noqa: UP045
        typer.Option(help="Judge by this exercise as it is now, instead of as it was then."),
    ] = None,
    json: Json = None,
    image: Image = None,
    html: Html = None,
    verbose: Verbose = False,
) -> None:
    """Judge a stored recording again; nothing of the student's is run."""
    from grader.checks.exercises import find_exercise, load_exercise
    from grader.report.files import check_writable
    from grader.report.report import report_of
    from grader.submission.reader import read

    for file in (json, image, html):
        check_writable(file)
    other = find_exercise(exercise) if exercise else None
    kept, outcomes = read(_judged, recording, (lambda _: other) if other else load_exercise)
    report = report_of(kept.evidence, outcomes, kept.ros, {})
    _show(report, kept.evidence, json, image, html, verbose=verbose)


@app.command("class-page", rich_help_panel=TEACH, epilog="Example: grader class-page reports")
def class_page(
    folder: Annotated[
        Path, typer.Argument(help="Holds the reports of a class, as --json writes them; pages beside them.")
    ],
    out: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Option(help="Where the page goes; index.html in the folder when left out.", metavar="FILE.html"),
    ] = None,
) -> None:
    """Make one page of a class: who got what, what fails most and why, what to teach again."""
    from grader.report.html_class import PAGE, save_class_page

    file = out or folder / PAGE
    save_class_page(folder, file)
    typer.echo(f"The class page: {file}")


view.add_to(app)
setup.add_to(app)
classroom.add_to(app)
gradebook.add_to(app)
authoring.add_to(app)


def main() -> None:
    """Run the command; an error of ours is a sentence, and its exit code is that of docs/design.md, decision 9."""
    clean_own()
    if "_GRADER_COMPLETE" in os.environ:  # a shell asks which words may follow (grader.ros.shell)
        from typer.completion import completion_init  # type: ignore[attr-defined]

        completion_init()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # numpy's threads, as in grader.ros.installation
    try:
        app()
    except GraderError as error:
        typer.secho(f"grader: {error}", err=True, fg=typer.colors.RED if sys.stderr.isatty() else None)
        sys.exit(error.exit_code)
    except KeyboardInterrupt:
        sys.exit(130)
    except BrokenPipeError:
        # Whoever read us has gone, as in `grader check | head`.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        sys.exit(1)
    except Exception as error:
        if os.environ.get("GRADER_DEBUG"):
            raise
        refused = refusal(error)
        if refused:
            typer.secho(f"grader: {refused}", err=True)
            sys.exit(3)
        told = f"grader: a fault of the grader itself, not of your work: {type(error).__name__}: {error}"
        typer.secho(f"{told}\nGRADER_DEBUG=1 before the command shows where; please report that.", err=True)
        sys.exit(3)


def _judged(recording: Path, read_exercise: Callable[[Path], Exercise]) -> tuple[Archived, tuple[Outcome, ...]]:
    from grader.checks.judge import judge
    from grader.evidence import archive

    kept = archive.load(recording, read_exercise)
    return kept, judge(kept.evidence)


def _opened(path: Path | None, name: str | None) -> tuple[Exercise, Submission]:
    """Open what was named; where the folder alone does not tell the exercise, the package found below it may."""
    from grader.learner.meant import guessed, meant
    from grader.submission.package import open_answers, open_submission

    known, place = guessed(path, name)
    if known is not None and not known.package:
        return known, open_answers(place)
    opened = open_submission(place)
    return known or meant(opened.package_dir, None)[0], opened


def _show(
    report: Report,
    evidence: Evidence,
    json: Path | None,
    image: Path | None,
    html: Path | None,
    *,
    verbose: bool,
    following: str = "",
) -> None:
    from rich.console import Console

    from grader.report import terminal

    if json:
        from grader.report.files import write
        from grader.report.json import to_json

        write(json, to_json(report).encode())
    if image:
        from grader.report.picture import save_picture

        save_picture(evidence, report, image)
    if html:
        from grader.report.html import save_html

        save_html(evidence, report, html)
    console = Console(highlight=False)
    terminal.render(report, console, verbose=verbose)
    if following:
        console.print(following, soft_wrap=True)
    raise typer.Exit(report.exit_code)


if __name__ == "__main__":
    main()
