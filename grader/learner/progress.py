"""The progress of a learner in the steps of the course.

The progress is stored outside the package, so that deleting the package does not delete the progress.
"""

from __future__ import annotations

import fcntl
import json
import os
import secrets
from contextlib import contextmanager
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from grader.checks.outcome import Status
from grader.common import xdg
from grader.common.roots_files import belongs_to_root
from grader.common.system_errors import of_the_machine, refusal
from grader.common.whole_file import write_whole
from grader.errors import MachineError, UsageError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from grader.report.report import Report

_SCHEMA = 1
DEFAULT_WORKSPACE = Path("~/ros2_ws")


@dataclass(frozen=True)
class StepProgress:
    """The progress in one step: the learner's best points, the maximum points, and whether the step is passed."""

    points: float = 0.0
    max: float = 0.0
    passed: bool = False
    read: tuple[int, ...] = ()
    """The indices (in exercise.toml) of the hints that were read. A hint that is read again moves to the end."""
    failed: tuple[str, ...] = ()
    """The ids of the checks that failed in the last report, in the order of the report."""
    done: tuple[str, ...] = ()
    """The ids of the checks that passed in the last report."""


@dataclass(frozen=True)
class Progress:
    """A learner's progress in one workspace: the current step, and the progress in each step."""

    student: str
    current: str | None = None
    steps: dict[str, StepProgress] = field(default_factory=dict)

    def step(self, name: str) -> StepProgress:
        """Return the progress in a step. The progress is empty for a step that was not started."""
        return self.steps.get(name, StepProgress())

    def with_step(self, name: str, step: StepProgress) -> Progress:
        """Return a copy in which the progress in the step `name` is `step`."""
        return replace(self, steps={**self.steps, name: step})

    def at(self, name: str) -> Progress:
        """Return a copy in which the step `name` is the current step."""
        return replace(self, current=name, steps={**self.steps, name: self.step(name)})

    def graded(self, name: str, report: Report) -> Progress:
        """Return the progress after a new report. Points never decrease, and a passed step stays passed."""
        before = self.step(name)
        better = report.points >= before.points
        after = replace(
            before,
            points=report.points if better else before.points,
            max=report.max if better else before.max,
            passed=before.passed or report.exit_code == 0,
            failed=tuple(outcome.id for outcome in report.with_status(Status.FAILED)),
            done=tuple(outcome.id for outcome in report.with_status(Status.PASSED)),
        )
        return self.with_step(name, after)


def workspace_of(folder: Path | None) -> Path:
    """Return the absolute path of the workspace: `folder`, ROS2_WORKSPACE, or ~/ros2_ws.

    Raises:
        UsageError: the path begins with ~NAME, but there is no user NAME.
    """
    named = folder or Path(os.environ.get("ROS2_WORKSPACE") or DEFAULT_WORKSPACE)
    try:
        return named.expanduser().resolve()
    except RuntimeError as error:
        user, typed = named.parts[0][1:], str(named)
        message = f"{typed} is in the home folder of the user {user}, who does not exist. Did you mean ~/{typed[1:]}?"
        raise UsageError(message) from error


def state_file() -> Path:
    """Return the path of progress.json below XDG_STATE_HOME."""
    return xdg.state() / "progress.json"


def load(workspace: Path) -> Progress:
    """Return the progress in a workspace. For a new workspace, it is empty and has a random student id.

    Raises:
        MachineError: the file is damaged, cannot be read, or was written by another version of the grader.
    """
    data = _read(state_file())["workspaces"].get(str(workspace))
    if data is None:
        return Progress(student=secrets.token_hex(4))
    steps = {name: _step(step) for name, step in data["steps"].items()}
    return Progress(data["student"], data["current"], steps)


def _step(data: dict[str, Any]) -> StepProgress:
    # Older versions stored only the number of hints that were read, and hints were given in order.
    read = data.get("read", range(data.get("hints", 0)))
    lists = {"read": tuple(read), "failed": tuple(data.get("failed", ())), "done": tuple(data.get("done", ()))}
    return StepProgress(data["points"], data["max"], data["passed"], **lists)


def update(workspace: Path, change: Callable[[Progress], Progress]) -> Progress:
    """Change the progress in a workspace atomically. Other processes may write the progress at the same time.

        update(root, lambda known: known.at("03-circle-publisher"))

    Raises:
        MachineError: the file cannot be written, or `load` raises this error.
    """
    file = state_file()
    try:
        file.parent.mkdir(parents=True, exist_ok=True)
        with _alone(file):
            data = _read(file)
            changed = change(load(workspace))
            data["workspaces"][str(workspace)] = asdict(changed)
            write_whole(file, (json.dumps(data, indent=1) + "\n").encode())
    except OSError as error:
        more = (refusal(error) if of_the_machine(error) else belongs_to_root(Path(error.filename or file))) or (
            "Choose a folder that you can write to: export XDG_STATE_HOME=FOLDER"
        )
        message = f"Your progress could not be written to {file} ({error.strerror}). {more}"
        raise MachineError(message) from error
    return changed


@contextmanager
def _alone(file: Path) -> Iterator[None]:
    with file.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def _read(file: Path) -> dict[str, Any]:
    try:
        data = json.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return {"schema": _SCHEMA, "workspaces": {}}
    except (OSError, ValueError) as error:
        detail = error.strerror if isinstance(error, OSError) else str(error)
        more = "Move the file away to start again. Your work is not lost."
        if isinstance(error, PermissionError):
            more = belongs_to_root(file) or "Choose a folder of your own: export XDG_STATE_HOME=FOLDER"
        message = f"Your progress in {file} cannot be read ({detail}). {more}"
        raise MachineError(message) from error
    if not isinstance(data, dict) or data.get("schema") != _SCHEMA:
        message = (
            f"{file} was written by another version of the grader. Move the file away to start again. Your work is not "
            "lost."
        )
        raise MachineError(message)
    return data
