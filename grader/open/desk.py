"""The data that the page shows next to the lesson: the steps, the current step's checks, the verdict and the hints."""

from __future__ import annotations

import json
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING

from grader.checks.exercises import find_exercise
from grader.checks.outcome import Status
from grader.exercise.model import catalogue
from grader.learner import hints, progress
from grader.learner.run_node import executables
from grader.report.html import ShownCheck
from grader.report.verdict import tone, verdict

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from grader.checks.outcome import Outcome
    from grader.exercise.model import Exercise
    from grader.report.report import Report

OPEN = "open"
"""The kind of a check that has not been judged yet."""


@dataclass(frozen=True)
class Verdict:
    """The last verdict: its checks by id, its summary line and its tone, and the HTML of its details.

    Until the details are ready, `html` has those of the previous verdict.
    """

    checks: dict[str, dict[str, object]]
    line: str
    tone: str
    html: str


@dataclass(frozen=True)
class Content:
    """The part of the page that changes. `doing` is the stage of grading, or "".

    When `number` changes, the page loads the details of the verdict again.
    """

    exercise: str = ""
    folder: str = ""
    doing: str = ""
    problem: str = ""
    number: int = 0
    verdict: Verdict | None = None
    early: dict[str, dict[str, object]] | None = None
    """The checks whose failure was certain before the build. They are shown until the verdict is ready."""
    digest: str = ""
    """The digest of the submission when it was last read."""
    lacking: list[dict[str, object]] = field(default_factory=list)
    """The lines to add to the learner's package files for this step, and the tasks to do in these files."""


class Desk:
    """The content of the page. `show` is called after each change."""

    def __init__(self, show: Callable[[Content], object]) -> None:
        self._show = show
        self._content = Content()

    def begin(self, exercise: Exercise | None, folder: Path | None) -> None:
        """Show a new step, which has no verdict yet, or no step if `exercise` is None."""
        name = exercise.id if exercise else ""
        self._set(Content(exercise=name, folder=str(folder or ""), number=self._content.number + 1))

    def tell(self, doing: str) -> None:
        """Show the current stage of grading."""
        if doing != self._content.doing:
            self._set(replace(self._content, doing=doing))

    def read(self, digest: str, lacking: list[dict[str, object]]) -> None:
        """Show the lines and tasks that are missing from the package files of the submission with this digest."""
        self._set(replace(self._content, digest=digest, lacking=lacking))

    def early(self, outcomes: Sequence[Outcome]) -> None:
        """Show the checks whose failure is certain before the build."""
        self._set(replace(self._content, early={each.id: _check(each) for each in outcomes}, problem=""))

    def judged(self, report: Report) -> None:
        """Show a verdict. Keep the details of the previous verdict until `detailed` is called."""
        checks = {outcome.id: _check(outcome) for outcome in report.outcomes}
        before = self._content.verdict
        made = Verdict(checks, verdict(report), tone(report), before.html if before else "")
        self._set(replace(self._content, verdict=made, early=None, problem="", doing="Drawing"))

    def detailed(self, html: str) -> None:
        """Show the details of the verdict."""
        if self._content.verdict is not None:
            self._set(self._final(verdict=replace(self._content.verdict, html=html)))

    def failed(self, problem: str) -> None:
        """Show the reason why no verdict was reached."""
        self._set(self._final(problem=problem))

    def _final(self, *, verdict: Verdict | None = None, problem: str = "") -> Content:
        now = self._content
        return replace(now, doing="", problem=problem, number=now.number + 1, verdict=verdict, early=None)

    def _set(self, content: Content) -> None:
        self._content = content
        self._show(content)


def to_json(content: Content) -> str:
    """Return the content as one line of JSON."""
    return json.dumps(asdict(content))


def from_json(text: str | bytes) -> Content:
    """Return the content from a line that `to_json` returned."""
    data = json.loads(text)
    made = data["verdict"]
    return Content(**{**data, "verdict": made and Verdict(**made)})


def page_data(now: Content, workspace: Path) -> dict[str, object]:
    """Return the data for a page, without the state of the programs: the content and the learner's progress."""
    known = progress.load(workspace)
    exercise = find_exercise(now.exercise) if now.exercise else None
    step = known.step(now.exercise)
    checks = _checks(exercise, now) if exercise else []
    wrong = {check["file"] for check in checks if check["kind"] == Status.FAILED.value}
    return {
        "exercise": now.exercise,
        "title": exercise.title if exercise else "",
        "folder": now.folder,
        "doing": now.doing,
        "problem": now.problem,
        "number": now.number,
        "line": now.verdict.line if now.verdict else "",
        "tone": now.verdict.tone if now.verdict else "",
        "passed": now.verdict is not None and now.verdict.tone == "passed",
        "checks": checks,
        "hints": hints.read_hints(exercise, step) if exercise else [],
        "more_hints": exercise is not None and hints.has_next(exercise, step),
        # The learner may write a line differently, so the file must also be the reason for a failed check.
        "lacking": [each for each in now.lacking if each["file"] in wrong],
        "executables": executables(exercise) if exercise else [],
        "steps": [_step(name, known) for name in catalogue()],
    }


def _check(outcome: Outcome) -> dict[str, object]:
    shown = ShownCheck(0, outcome)
    return {
        "id": outcome.id,
        "title": shown.title,
        "points": outcome.points,
        "max": outcome.max,
        "kind": shown.kind,
        "text": shown.observed if outcome.status is not Status.PASSED else "",
        "file": outcome.finding.where.file if outcome.finding.where and not outcome.hidden else "",
    }


def _checks(exercise: Exercise, now: Content) -> list[dict[str, object]]:
    """Return all checks of the exercise in order, each with its result or with the kind OPEN."""
    judged = {**(now.verdict.checks if now.verdict else {}), **(now.early or {})}
    return [
        judged.get(spec.id)
        or {
            "id": spec.id,
            "title": "Hidden check" if spec.hidden else spec.title,
            "points": 0.0,
            "max": spec.points,
            "kind": OPEN,
            "text": "",
            "file": "",
        }
        for spec in exercise.checks
    ]


def _step(name: str, known: progress.Progress) -> dict[str, object]:
    step = known.step(name)
    state = "passed" if step.passed else "begun" if name in known.steps else "new"
    return {"id": name, "state": state, "points": step.points, "max": step.max, "current": name == known.current}
