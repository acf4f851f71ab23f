"""Grade a class, from a folder of submissions to a folder of results. This implements `grader grade`."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING

from grader.checks.outcome import Status
from grader.classroom import result_files, results
from grader.classroom.class_run import run
from grader.classroom.find_submissions import find_submissions, passed_over
from grader.classroom.found import what_to_do_with
from grader.classroom.order import Order, sort_out, sources_for
from grader.classroom.progress_display import screen, summary
from grader.classroom.roster import read_owners
from grader.common.updated import updated
from grader.common.words import a_list, count
from grader.errors import MachineError, UsageError
from grader.ros import underlay
from grader.ros.installation import find_ros
from grader.sandbox import bubblewrap

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from grader.classroom.engine import Engine
    from grader.classroom.found import Found
    from grader.classroom.order import Todo
    from grader.classroom.results import Result
    from grader.grading.clock import ClockChoice

DASK = "dask://"
_DASK = re.compile(rf"{DASK}\S+:\d{{1,5}}")
UPDATED = (
    "The course was updated during this run, so these results may come from a mixture of two versions. Run the same "
    "command again: it grades all submissions with the new version."
)


@dataclass(frozen=True)
class Request:
    """The arguments and options of `grader grade`, except --fail-under."""

    submissions: Sequence[Path]
    out: Path
    exercise: str | None = None
    jobs: int | None = None
    engine: str = "local"
    checks: Path | None = None
    roster: Path | None = None
    clock: ClockChoice = "auto"
    seed: int | None = None
    trusted: bool = False
    explain: bool = True
    repository_folder: str = ""


def grade_class(request: Request, say: Callable[[str], None], tell: Callable[[str], None]) -> list[Result]:
    """Grade each submission that has no valid result yet, and write all files. Return all results, sorted by student.

    Raises:
        UsageError: an argument of the command is wrong.
        MachineError: the machine can no longer grade submissions or write results. The results so far are kept, and the
            next run continues from there.
    """
    _engine_is_known(request)
    return grade_found(request, find_submissions(request.submissions, request.exercise, request.out), say, tell)


def grade_found(
    request: Request, found: tuple[Found, ...], say: Callable[[str], None], tell: Callable[[str], None]
) -> list[Result]:
    """Grade submissions that have already been found. Raises the same exceptions as `grade_class`."""
    local = _engine_is_known(request)
    owners = read_owners(request.roster) if request.roster else None
    beside = passed_over(request.submissions, request.out)
    sources = sources_for(found, request.checks)
    order = Order(
        found=found,
        roster=owners.students if owners else {},
        sources=sources,
        ros=_ros(local=local, tell=tell),
        clock=request.clock,
        seed=request.seed,
        explain=request.explain,
        # Each Dask worker tests its own machine.
        in_cell=bubblewrap.require(trusted=request.trusted) if local else not request.trusted,
        trusted=request.trusted,
    )
    assert order.exercises  # report mistakes in private checks before grading
    # `grader gradebook sync` gives no folders, and its folder of results cannot be chosen.
    with results.opened(request.out, request.submissions, chosen=bool(request.submissions)) as folder:
        tell(f"Reading {count(len(found), 'submission')}")
        kept, todo = sort_out(order, folder)
        say(_reported(kept, todo))
        if beside:
            what = "is not a submission" if len(beside) == 1 else "are not submissions"
            say(f"Ignored: {a_list(beside)} {what}.{what_to_do_with(beside)}")
        for remark in owners.remarks(each.student for each in found) if owners else ():
            say(remark)
        graded: list[Result] = []
        if todo:
            engine = _engine(request, tell, local=local)
            with screen(len(todo), several=len(sources) > 1) as shown:
                graded = run(order, todo, engine, folder, shown)
        every = {(result.student, result.report.exercise): result for result in (*kept, *graded)}
        ordered = [every[each.student, each.exercise] for each in found]
        result_files.write_all(folder, ordered, request.repository_folder)
        left = folder.others({result.page for result in ordered})
    say(summary(ordered))
    if graded and updated():
        say(UPDATED)
    if left:
        say(f"Not changed: {count(left, 'result')} of other submissions in {request.out}/{results.REPORTS}.")
    return ordered


def _engine_is_known(request: Request) -> bool:
    """Return whether the engine is "local", that is, this machine. Raises UsageError for an unknown engine."""
    local = request.engine == "local"
    if not local and not _DASK.fullmatch(request.engine):
        message = f'--engine is "{request.engine}". The engine must be local or {DASK}HOST:PORT.'
        raise UsageError(message)
    return local


def exit_code(graded: Sequence[Result], fail_under: float | None) -> int:
    """Return 3 if a report contains an `error`, 1 if a submission got less than `fail_under` percent, or else 0."""
    if any(result.report.with_status(Status.ERROR) for result in graded):
        return 3
    shares = [result.report.points / result.report.max if result.report.max else 0.0 for result in graded]
    # Without the tolerance, a rounding error could fail a class.
    return 1 if fail_under is not None and any(100.0 * share < fail_under - 1e-9 for share in shares) else 0


def _ros(*, local: bool, tell: Callable[[str], None]) -> str:
    """Return the name of the ROS 2 installation that the results depend on.

    With Dask, all workers must have the same ROS 2. If this machine has none, the name is "of the workers".
    """
    try:
        ros = find_ros()
        if local:
            underlay.ensure(ros, tell)  # build it once here, not in all workers at the same time
    except MachineError:
        if local:
            raise
        return "of the workers"
    return ros.name


def _engine(request: Request, tell: Callable[[str], None], *, local: bool) -> Engine:
    if local:
        from grader.classroom.local import LocalEngine, default_jobs

        return LocalEngine(request.jobs or default_jobs())
    from grader.classroom.dask_engine import DaskEngine

    return DaskEngine(request.engine.removeprefix(DASK), request.jobs, tell)


def _reported(kept: Sequence[Result], todo: Sequence[Todo]) -> str:
    reasons = Counter(one.why for one in todo)
    why = ", ".join(f"{amount} {reason}" for reason, amount in reasons.most_common())
    before = f"{len(kept)} already graded, " if kept else ""
    to_grade = f"{len(todo)} to grade" + (f" ({why})" if reasons.keys() - {"new"} else "")
    return f"{count(len(kept) + len(todo), 'submission')}: {before}{to_grade if todo else 'nothing to grade'}."
