"""A folder for tests of the set-up, in which no command is executed."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from grader.setup import bootstrap
from grader.setup.bootstrap import Stamp
from grader.setup.machine import Python, SourcedRos

if TYPE_CHECKING:
    from pathlib import Path

    from grader.common.package_managers import Need

SYSTEMS = Python("/usr/bin/python3.11", (3, 11, 2), cpython=True, venv=True, headers=True)
LEARNER, TESTS = bootstrap.PARTS["learner"], bootstrap.PARTS["tests"]


class Course:
    """A folder for the set-up. Commands are recorded instead of executed."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.stamp = root / ".venv/course-setup.json"
        self.path_file = root / ".venv/lib/python3.11/site-packages/_editable_impl_course.pth"
        self.commands: list[list[str]] = []
        self.python = SYSTEMS
        self.needs: list[Need] = []
        self.of_tests: list[Need] = []
        self.requested: list[list[str]] = []
        self.offline = False
        self.granted: set[str] = set()
        """The packages that can be installed."""

    def call(self, command: list[str], **_options: object) -> int:
        self.commands.append(list(map(str, command)))
        if "venv" in command:
            assert not self.stamp.exists()
            self.stamp.parent.mkdir(exist_ok=True)
        if "grader.setup.install" in command:
            assert not self.stamp.exists()
            bootstrap.write_stamp(Stamp(**json.loads(command[-1])), self.stamp)
            self.path_file.parent.mkdir(parents=True, exist_ok=True)
            self.path_file.write_text(f"{self.root}\n")
        return 0

    def provide(self, needs: list[Need], *_: object) -> str:
        """Replace the package manager."""
        self.requested.append([need.package for need in needs])
        self.needs = [need for need in self.needs if need.package not in self.granted]
        self.of_tests = [need for need in self.of_tests if need.package not in self.granted]
        return "" if {need.package for need in needs} <= self.granted else "not allowed"

    @property
    def programs(self) -> list[str]:
        """Return the name of each command that was run: venv or grader.setup.install."""
        known = ("venv", "grader.setup.install")
        return [next(word for word in command if word in known) for command in self.commands]

    def set_up(self, parts: list[str] = LEARNER, ros: SourcedRos | None = None) -> int:
        self.commands, self.requested = [], []
        return bootstrap.set_up(parts, ros, None)
