"""`python -m grader.view.turtlesim_node`: the program of `ros2 run turtlesim turtlesim_node` and `grader sim`.

The simulator itself does not import the view. This module adds the view that the option --view requests.
"""

from __future__ import annotations

import signal
import sys
from typing import TYPE_CHECKING

from grader.common.own_process import prepare

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

    from grader.turtlesim.standalone import Kind, View


def open_view(kind: Kind, port: int | None) -> AbstractContextManager[View]:
    """Import and start a view. Raises the same exceptions as `grader.view.launch.view`."""
    from grader.view.launch import view

    return view(kind, port)


def main() -> None:
    """Run turtlesim until Ctrl-C, and exit."""
    # Ctrl-C terminates the program without a traceback, even while ROS 2 is being imported.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, [signal.SIGINT])
    prepare()
    from grader.turtlesim import standalone

    sys.exit(standalone.main(open_view))


if __name__ == "__main__":
    main()
