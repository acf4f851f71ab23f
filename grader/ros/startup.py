"""Start commands such as `ros2`: run the real command if there is one, or else add ROS 2 to the environment."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common.interpreter import interpreter
from grader.common.terminal_text import say
from grader.ros import index

if TYPE_CHECKING:
    from collections.abc import Collection

_STARTED_AGAIN = "_GRADER_ROS2_STARTED_AGAIN"


def hand_over(command: str, package: str) -> None:
    """Replace this process with the real command if a sourced ROS 2 has it, even if it is not the first on PATH."""
    ours = Path(sys.argv[0])
    for prefix in filter(None, os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)):
        theirs = Path(prefix, "bin", command)
        installed = Path(prefix, "share/ament_index/resource_index/packages", package).is_file()
        if installed and os.access(theirs, os.X_OK) and not (ours.exists() and theirs.samefile(ours)):
            os.execv(theirs, [str(theirs), *sys.argv[1:]])


def see_to_environment(needed: Collection[str]) -> None:
    """Restart this command with ROS 2 in the environment, unless all needed packages can already be found.

    A command that was restarted is not restarted again.

    Raises:
        MachineError: ROS 2 was not found, turtlesim could not be built, or no folder for logs could be created.
        UsageError: ROS_DOMAIN_ID is not a valid domain id.
    """
    if "RMW_IMPLEMENTATION" in os.environ and index.packages().get("rclpy") == Path(sys.prefix):
        # The user may have set this for another ROS 2. Without it, the wheels use the middleware that they have.
        del os.environ["RMW_IMPLEMENTATION"]
    if _STARTED_AGAIN in os.environ or all(map(index.has_package, needed)):
        os.environ.pop(_STARTED_AGAIN, None)
        return
    from grader.ros import shell

    wanted = shell.users_environment(None, lambda text: say(f"{text} ..."))
    command = str(Path(sys.argv[0]).absolute())
    again = interpreter(command, *sys.argv[1:], env={**wanted, _STARTED_AGAIN: "1"}, searches=True)
    signal.pthread_sigmask(signal.SIG_BLOCK, [signal.SIGINT])  # until the command can handle Ctrl-C
    os.execve(again.argv[0], again.argv, again.env)
