"""The command `grader`: what its verbs take, and which part of the grader does them. No logic."""

from __future__ import annotations

import os
import sys
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Optional

import typer

from grader.classroom import cli as classroom
from grader.common.interpreter import clean_own
from grader.errors import GraderError, UsageError
from grader.gradebook import cli as gradebook
from grader.learner import cli as learner

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from grader.checks.outcome import Report
    from grader.evidence.evidence import Evidence
    from grader.exercise.model import Exercise
    from grader.report.progress import Progress
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
ExerciseId = Annotated[
    Optional[str],  # noqa: UP045 - typer reads the annotation, and Python 3.10 has to
    typer.Option("--exercise", help="Which exercise; in exercises/ and solutions/ it follows from the folder."),
]


@app.command(epilog="Example: grader check ~/ros2_ws/src/my_robot_controller --exercise 03-circle-publisher")
def check(
    submission: Annotated[
        Optional[Path],  # noqa: UP045
        typer.Argument(help="A package's folder, or a folder with one below it; your current step's when left out."),
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
) -> None:
    """Build and run one submission, and say what is right and what is not."""
    from grader.evidence import archive
    from grader.grading.grade import Options, grade
    from grader.report.terminal import early
    from grader.sandbox import bubblewrap

    for file in (json, image, html):
        _writable(file)
    if recording:
        archive.check_free(recording)
    if submission is None:
        from grader.learner.cli import place

        known, submission = place(None, exercise)
        exercise = known.id
    asked, opened = _opened(exercise, submission)
    options = Options(in_cell=bubblewrap.require() if confined else bubblewrap.usable(), clock=clock.value, seed=seed)
    with _progress() as tell:
        graded = grade(asked, opened, options, tell, early=lambda failed: tell.keep_all(early(failed)))
        if recording:
            archive.save(recording, graded.evidence, graded.report.ros, graded.prefixes)
    from grader.learner import steps

    steps.note(asked, opened.package_dir, graded.report)
    _show(graded.report, graded.evidence, json, image, html)


@app.command(epilog="Example: grader regrade my-recording --image path.png")
def regrade(
    recording: Annotated[Path, typer.Argument(help="What `grader check --recording` wrote.", metavar="RECORDING")],
    exercise: Annotated[
        Optional[str],  # noqa: UP045
        typer.Option(help="Judge by this exercise as it is now, instead of as it was then."),
    ] = None,
    json: Json = None,
    image: Image = None,
    html: Html = None,
) -> None:
    """Judge a stored recording again; nothing of the student's is run."""
    from grader.checks.exercises import find_exercise, load_exercise
    from grader.checks.judge import judge
    from grader.evidence import archive
    from grader.grading.grade import report_of

    for file in (json, image, html):
        _writable(file)
    other = find_exercise(exercise) if exercise else None
    kept = archive.load(recording, (lambda _: other) if other else load_exercise)
    report = report_of(kept.evidence, judge(kept.evidence), kept.ros, {})
    _show(report, kept.evidence, json, image, html)


@app.command("class-page", epilog="Example: grader class-page reports")
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


@app.command(epilog="Example: grader doctor")
def doctor() -> None:
    """See whether this machine can grade: which ROS 2, colcon, compiler, sandbox; and what to do about the rest."""
    from rich.console import Console

    from grader.setup.doctor import exit_code, render, run_doctor

    with _progress() as tell:
        lines = run_doctor(tell=tell)
    render(lines, Console(highlight=False))
    raise typer.Exit(exit_code(lines))


@app.command(
    context_settings={"allow_extra_args": True, "ignore_unknown_options": True},
    epilog="Examples: grader sim --view; in a terminal without a browser: grader sim --view terminal",
)
def sim(
    context: typer.Context,
    image: Image = None,
    view: Annotated[
        bool,
        typer.Option("--view", help="See it move, on a page of this machine; `--view terminal`: in this terminal."),
    ] = False,
    port: Annotated[Optional[int], typer.Option(help="Of the page; the one of the last time when left out.")] = None,  # noqa: UP045
) -> None:
    """Run turtlesim as a node, at wall time, until Ctrl-C; it has no window, so --view shows it."""
    from grader.common.interpreter import interpreter
    from grader.ros import underlay
    from grader.ros.installation import find_ros, users_environment

    _writable(image)
    here = find_ros()
    with _progress() as tell:
        extra = underlay.ensure(here, tell)
    # typer has no option that may stand with and without a value.
    where = context.args.pop(0) if view and context.args[:1] in (["page"], ["terminal"]) else "page"
    given = [("--image", image), ("--view", where if view else None), ("--port", port)]
    options = [text for name, value in given if value is not None for text in (name, str(value))]
    env = users_environment(here, extra)
    start = interpreter(
        "-m", "grader.view.turtlesim_node", *options, *context.args, python=str(here.python), env=env, searches=True
    )
    os.execve(start.argv[0], start.argv, start.env)


Domain = Annotated[
    Optional[int],  # noqa: UP045
    typer.Option(help="Which ROS domain: 0 to 101. Without it the one that is set, else one of your own."),
]


@app.command(epilog="Example: source <(grader env)")
def env(domain: Domain = None) -> None:
    """Print shell code that puts ROS 2 into this shell: for `source <(grader env)`, in bash and zsh."""
    from grader.ros import shell

    try:
        with _progress() as tell:
            wanted = shell.users_environment(domain, tell)
    except GraderError:
        # Whoever sources this sees nothing of our exit code.
        print("false")
        raise
    sys.stdout.write(shell.code(wanted))


@app.command(epilog="Example: grader shell --domain 7")
def shell(domain: Domain = None) -> None:
    """Open a shell in which ROS 2 is there, until you type exit."""
    from grader.ros import shell as shells

    with _progress() as tell:
        wanted = shells.users_environment(domain, tell)
    print(f"A shell with ROS 2, in domain {wanted['ROS_DOMAIN_ID']}. To leave it: exit")
    sys.stdout.flush()
    shells.open_shell(wanted)


@app.command(epilog="Example: grader release --to ../for-students")
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


@app.command(epilog="Example: grader validate 03-circle-publisher")
def validate(
    exercises: Annotated[list[str] | None, typer.Argument(help="Which ones; all when left out.", metavar="ID")] = None,
) -> None:
    """See whether exercises, solutions, starting points and lessons are as they should be, for authors."""
    from grader.authoring.validate import validate as problems_of

    with _progress() as tell:
        problems = problems_of(exercises or [], tell)
    for problem in problems:
        typer.echo(f"- {problem}")
    typer.echo(f"{len(problems)} problems." if problems else "Everything is as it should be.")
    raise typer.Exit(1 if problems else 0)


learner.add_to(app)
classroom.add_to(app)
gradebook.add_to(app)


def main() -> None:
    """Run the command; an error of ours is a sentence, and its exit code is that of design.md."""
    clean_own()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # numpy's threads, as in ros.environment
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
        told = f"grader: a fault of the grader itself, not of your work: {type(error).__name__}: {error}"
        typer.secho(f"{told}\nGRADER_DEBUG=1 before the command shows where; please report that.", err=True)
        sys.exit(3)


def _opened(name: str | None, path: Path) -> tuple[Exercise, Submission]:
    from grader.checks.exercises import exercise_of_folder, find_exercise
    from grader.submission.package import open_answers, open_submission

    known = find_exercise(name) if name else exercise_of_folder(path)
    if known is not None and not known.package:
        return known, open_answers(path)
    opened = open_submission(path)
    return known or _exercise(name, opened.package_dir), opened


def _exercise(name: str | None, package: Path) -> Exercise:
    from grader.checks.exercises import exercise_of_folder, find_exercise
    from grader.exercise.model import catalogue

    found = find_exercise(name) if name else exercise_of_folder(package)
    if found is None:
        message = (
            f"Which exercise is {package.name} for? Say it with --exercise, one of: {', '.join(catalogue())}. "
            "(In exercises/ and solutions/ it follows from the folder.)"
        )
        raise UsageError(message)
    return found


def _show(report: Report, evidence: Evidence, json: Path | None, image: Path | None, html: Path | None) -> None:
    from rich.console import Console

    from grader.report import terminal

    if json:
        from grader.report.json import to_json

        _write(json, to_json(report).encode())
    if image:
        from grader.report.picture import save_picture

        save_picture(evidence, report, image)
    if html:
        from grader.report.html import save_html

        save_html(evidence, report, html)
    console = Console(highlight=False)
    terminal.render(report, console)
    raise typer.Exit(report.exit_code)


def _progress() -> AbstractContextManager[Progress]:
    from grader.report.progress import progress

    return progress()


def _writable(file: Path | None) -> None:
    """See that a file can be written before time is spent on what goes into it."""
    if file is not None and not file.absolute().parent.is_dir():
        message = f"There is no folder {file.absolute().parent} to write {file.name} to."
        raise UsageError(message)
    if file is not None and file.is_dir():
        message = f"{file} is a folder; name a file."
        raise UsageError(message)


def _write(file: Path, content: bytes) -> None:
    try:
        file.write_bytes(content)
    except OSError as error:
        message = f"{file} could not be written: {error.strerror}."
        raise UsageError(message) from error


if __name__ == "__main__":
    main()
