"""`python -m grader.turtlesim [--image FILE.png] [--ros-args ...]`: turtlesim alone, until Ctrl-C."""

from __future__ import annotations

import signal
import sys


def main() -> None:
    """Run it and exit."""
    # Ctrl-C ends quietly from the first moment: while ROS 2 is being imported too, which takes a while.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    from grader.turtlesim import standalone

    sys.exit(standalone.main())


if __name__ == "__main__":
    main()
