"""Run a function of a test in a process with ROS 2. The tests' own process has no ROS 2.

The function is passed by name, because its module cannot be imported in the process that runs the tests. The function
receives and returns JSON. If the function raises an exception, the test fails.
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
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from pathlib import Path

_RESULT = "RESULT: "


@dataclass(frozen=True)
class Ran:
    """The result of the function, and what the process wrote to standard error."""

    result: Any
    stderr: str


@dataclass(frozen=True)
class InRos:
    """Starts processes with ROS 2, each in its own domain."""

    ros: installation.Ros
    home: Path

    def environment(self) -> dict[str, str]:
        """The environment of one process. Processes in other domains do not receive the messages of this process."""
        return installation.environment(self.ros, home=self.home, domain=own_domain())

    def run(self, name: str, *arguments: object) -> Ran:
        """Call a function of grader.tests in a separate process.

        The name of the function has the form "turtlesim.scenarios:graph".
        """
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
    """Call the function and print its result as JSON. This function runs in the process with ROS 2."""
    module, function = name.split(":")
    result = getattr(importlib.import_module(f"grader.tests.{module}"), function)(*json.loads(arguments))
    print(_RESULT + json.dumps(result))
    sys.stdout.flush()
