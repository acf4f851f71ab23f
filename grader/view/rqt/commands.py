"""The commands `rqt`, `rqt_console` and `rqt_plot`: show parts of a page in the browser until Ctrl-C."""

from __future__ import annotations

import argparse
import os
import signal
import sys
from typing import TYPE_CHECKING

from grader.common.own_process import prepare
from grader.errors import GraderError
from grader.ros.startup import hand_over, see_to_environment

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.view.rqt.rqt_page import Part


def rqt() -> int:
    """Run `rqt`: show the graph, the log, a plot and a service caller on one page."""
    parser = _parser(
        "rqt",
        "Show the graph, the log messages, a plot and a service caller on one page in the browser.",
        "Example: rqt",
    )
    return _main("rqt_gui", parser, ("graph", "console", "plot", "services"))


def rqt_console() -> int:
    """Run `rqt_console`: show the log messages of all nodes."""
    parser = _parser(
        "rqt_console",
        "Show and filter the log messages of all nodes on a page in the browser.",
        "Example: rqt_console",
    )
    return _main("rqt_console", parser, ("console",))


def rqt_plot() -> int:
    """Run `rqt_plot`: plot numeric fields over time."""
    parser = _parser(
        "rqt_plot",
        "Plot numeric fields of messages over time on a page in the browser.",
        "Examples: rqt_plot /turtle1/pose/x; rqt_plot /turtle1/pose/x:y:theta",
    )
    wanted = parser.add_argument(
        "fields", nargs="*", metavar="FIELD", help="the topic and the field, as in /turtle1/pose/x"
    )
    wanted.completer = _fields  # type: ignore[attr-defined]
    return _main("rqt_plot", parser, ("plot",))


def _parser(command: str, description: str, epilog: str) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog=command, description=description, epilog=epilog)
    parser.add_argument("--port", type=int, help="port of the page (default: the same as last time, or a free one)")
    return parser


def _main(package: str, parser: argparse.ArgumentParser, parts: Sequence[Part]) -> int:
    """Run a command.

    `package` is the ROS package of the real command. Decision 9 in docs/design.md defines the exit codes.
    """
    prepare()
    try:
        if "_ARGCOMPLETE" in os.environ:
            from argcomplete import autocomplete

            autocomplete(parser)
        hand_over(parser.prog, package)
        options = parser.parse_args()
        see_to_environment({"rclpy"})
        _serve(parser.prog, parts, getattr(options, "fields", []), options.port)
    except GraderError as error:
        print(f"{parser.prog}: {error}", file=sys.stderr)
        return error.exit_code
    except KeyboardInterrupt:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # while Python exits, Ctrl-C would only print a traceback
        return 130
    return 0


def _fields(**_: object) -> list[str]:
    """Return all numeric fields of the topics in the running graph, for shell completion."""
    from grader.graph.discovery import cli_node, settle
    from grader.graph.endpoints import observe
    from grader.view.rqt.plot_fields import fields_of

    with cli_node() as node:
        settle(node)
        return fields_of(observe(node))


def _serve(command: str, parts: Sequence[Part], fields: Sequence[str], port: int | None) -> None:
    """Serve the page until Ctrl-C. If no browser was found, print how to open the page."""
    import asyncio

    from grader.view import browser
    from grader.view.address import listen
    from grader.view.launch import see_that_it_can_be_served

    see_that_it_can_be_served()
    # Import rclpy only after checking that the page can be served, since this import is slow.
    from grader.view.rqt.rqt_page import RqtPage

    place = listen(command, port)
    print(f"{command} is at {place.address.url} until Ctrl-C.", flush=True)
    if not browser.there_is_one():
        print(browser.from_elsewhere(place.address.port), file=sys.stderr, flush=True)
    asyncio.run(RqtPage(parts, fields).serve(place, stays=True))
    # From now on, Python handles Ctrl-C again.
    signal.signal(signal.SIGINT, signal.default_int_handler)
