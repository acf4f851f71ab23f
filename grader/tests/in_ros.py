"""Run a function of a test in a process of its own that has ROS 2: the tests' own process has none.

The function is named, since the tests' own process cannot import what it imports. It gets JSON and returns JSON; what
it raises fails the test.
"""

from __future__ import annotations

import importlib
import json
import subprocess
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from grader.ros import installation
from grader.tests.domains import own_domain

if TYPE_CHECKING:
    from pathlib import Path

HANG_S = 300.0
_RESULT = "RESULT: "


@dataclass(frozen=True)
class Ran:
    """What the function returned, and what the process wrote to standard error."""

    result: Any
    stderr: str


@dataclass(frozen=True)
class InRos:
    """Starts processes that have ROS 2, each in a domain of its own."""

    ros: installation.Ros
    home: Path

    def environment(self) -> dict[str, str]:
        """The environment of one process; processes in other domains do not receive its messages."""
        return installation.environment(self.ros, home=self.home, domain=own_domain())

    def run(self, name: str, *arguments: object) -> Ran:
        """Call a function, named as in "turtlesim.scenarios:graph" from grader.tests, in a process of its own."""
        code = "import sys; from grader.tests import in_ros; in_ros.call(*sys.argv[1:])"
        done = subprocess.run(
            [self.ros.python, "-c", code, name, json.dumps(arguments)],
            env=self.environment(),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=HANG_S,
            check=False,
        )
        assert done.returncode == 0, f"{name} failed:\n{done.stderr}"
        result = next(line for line in done.stdout.splitlines() if line.startswith(_RESULT))
        return Ran(json.loads(result.removeprefix(_RESULT)), done.stderr)


def call(name: str, arguments: str) -> None:
    """What runs inside."""
    module, function = name.split(":")
    result = getattr(importlib.import_module(f"grader.tests.{module}"), function)(*json.loads(arguments))
    print(_RESULT + json.dumps(result))
    sys.stdout.flush()
