"""What a page can request, each a function of its JSON; nothing else can be started or changed from a page."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from grader.errors import UsageError
from grader.exercise.model import catalogue
from grader.learner import hints, steps
from grader.open.grading import RERUN, STEP

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path


def actions(
    tell: Callable[[str], object], workspace: Path | None
) -> Mapping[str, Callable[[Mapping[str, Any]], object]]:
    """Return the actions by name. Each returns data for JSON, and raises GraderError with a sentence for the page.

    `tell` passes a word of grading.py on to the process that grades.
    """

    def start(request: Mapping[str, Any]) -> object:
        """Start a step, or the next one. Files of the learner are not overwritten."""
        step = request.get("step")
        if not isinstance(step, str) or (step != "next" and step not in catalogue()):
            message = "There is no such step."
            raise UsageError(message)
        begun = steps.start(step, workspace)
        tell(STEP)
        lacking = [{"file": path, "lines": list(lines)} for path, lines in begun.started.lacking.items()]
        return {"step": begun.exercise.id, "folder": str(begun.started.folder), "lacking": lacking}

    def hint(_: Mapping[str, Any]) -> object:
        """Read the next hint of the current step."""
        return {"text": hints.hint(None, workspace)}

    def rerun(_: Mapping[str, Any]) -> object:
        """Grade again."""
        tell(RERUN)
        return {}

    return {"start": start, "hint": hint, "rerun": rerun}
