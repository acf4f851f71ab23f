"""`python -m grader.view (page | terminal) --feed FD ...`: the process of a view, which a simulator starts."""

from __future__ import annotations

import argparse
import os
import signal
import socket
import sys

from grader.common.terminal_text import say
from grader.errors import GraderError


def main() -> int:
    """Run the view until the simulator exits or, in a terminal, the user quits. Return the exit code."""
    # Ctrl-C terminates the program without a traceback, even while ROS 2 is being imported.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    parser = argparse.ArgumentParser(
        prog="python -m grader.view", description="The process of a view, which turtlesim_node --view starts."
    )
    parser.add_argument("kind", choices=("page", "terminal"))
    parser.add_argument("--feed", type=int, required=True, help="the socket to the simulator")
    parser.add_argument("--listen", type=int, help="the socket to serve the page on")
    parser.add_argument("--before", action="store_true", help="a tab from the last run may still be open")
    parser.add_argument("--said", type=int, help="a pipe with the output of the simulator")
    options = parser.parse_args()
    feed = socket.socket(fileno=options.feed)
    try:
        if options.kind == "terminal":
            from grader.view.terminal_view import watch

            return watch(feed, options.said)
        import asyncio

        from grader.view.address import Address, Place
        from grader.view.page import Page

        listening = socket.socket(fileno=options.listen)
        address = Address(listening.getsockname()[1], os.environ.pop("GRADER_VIEW_TOKEN"))
        place = Place(address, listening, options.before)

        async def serve() -> None:
            await Page(feed).serve(place)

        asyncio.run(serve())
    except GraderError as error:
        say(f"The view has stopped: {error}")
        return error.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main())
