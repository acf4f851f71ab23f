"""The actions that a page can request. Each action is a method with the JSON of the request as its argument."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from grader.errors import UsageError
from grader.exercise.model import catalogue
from grader.learner import hints, steps
from grader.learner.run_node import executables
from grader.open.grading import RERUN, STEP
from grader.open.question import answer, arguments
from grader.ros.shell import users_environment

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from grader.open.programs import Programs

    Request = Mapping[str, Any]


@dataclass(frozen=True)
class Actions:
    """The actions of a page.

    Each action returns data that can be written as JSON, or raises GraderError with a message for the page.

    `tell` sends a command (see grading.py) to the grading process. `digest` returns the digest of the
    learner's code.
    """

    tell: Callable[[str], object]
    workspace: Path | None
    programs: Programs
    digest: Callable[[], str]

    def all(self) -> Mapping[str, Callable[[Request], Any]]:
        """Return the actions by name. Some of them are coroutine functions."""
        threaded = {"start": self.start, "hint": self.hint, "rerun": self.rerun, "ask": self.ask}
        return {**threaded, "turtlesim": self.turtlesim, "node": self.node}

    def start(self, request: Request) -> object:
        """Start a step, or the next one (see `steps.start`). Files of the learner are not overwritten."""
        step = request.get("step")
        if not isinstance(step, str) or (step != "next" and step not in catalogue()):
            message = "The step does not exist."
            raise UsageError(message)
        begun = steps.start(step, self.workspace)
        self.tell(STEP)
        return {"step": begun.exercise.id}

    def hint(self, _: Request) -> object:
        """Return the next hint of the current step."""
        return {"text": hints.hint(None, self.workspace)}

    def rerun(self, _: Request) -> object:
        """Ask the grader to grade once more."""
        self.tell(RERUN)
        return {}

    def ask(self, request: Request) -> object:
        """Run a `ros2` command that changes nothing."""
        words = arguments(str(request.get("text", "")))
        env = users_environment(None, lambda _: None, {**os.environ, "GRADER_ROS2_DAEMON": "0"})
        found = answer(words, env)
        return {"command": " ".join(["ros2", *words]), "output": found.output, "stopped": found.stopped}

    async def turtlesim(self, request: Request) -> object:
        """Start or stop turtlesim."""
        on = request.get("on") is True
        with self.programs.doing("Starting turtlesim" if on else "Stopping turtlesim"):
            if not on:
                await self.programs.turtlesim.stop()
            elif await self.programs.beside_another():
                message = (
                    "Another turtlesim is already running, for example in a terminal. To see a turtlesim here, first "
                    "end the other turtlesim with Ctrl-C."
                )
                raise UsageError(message)
            else:
                await self.programs.start_turtlesim()
        return {}

    async def node(self, request: Request) -> object:
        """Start, stop or restart a node of the current step."""
        if request.get("on") is not True:
            with self.programs.doing("Stopping your node"):
                await self.programs.node.stop()
            return {}
        current = steps.current(self.workspace)
        name = request.get("executable")
        if current is None or name not in executables(current[0]):
            message = "This step has no program with this name."
            raise UsageError(message)
        with self.programs.doing(f"Starting {name}"):
            if request.get("again") is True:
                await self.programs.node.stop()
            await self.programs.start_node(current[0].id, str(name), self.digest())
        return {}
