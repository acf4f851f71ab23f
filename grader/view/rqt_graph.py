"""The command `rqt_graph`: show the ROS graph live on a page, as an image in a file, or as text."""

from __future__ import annotations

import argparse
import os
import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common.own_process import prepare
from grader.common.plain_output import protect_terminal
from grader.common.terminal_text import say
from grader.errors import GraderError, MachineError, UsageError
from grader.graph.graph import Show, picture, to_dot, to_text
from grader.graph.layout import Format, render
from grader.ros.startup import hand_over, see_to_environment

if TYPE_CHECKING:
    from collections.abc import Sequence

    from grader.graph.graph import Picture

_FORMATS = (".svg", ".png", ".dot")
_OURS = ("-o", "--output", "--text", "--port", "--active", "--debug", "--hidden", "--all")
"""The options that the rqt_graph of a sourced ROS 2 does not support."""
_NOTHING = (
    "No node was found (ROS_DOMAIN_ID is {domain}). Start a node in another terminal, with the same domain id: "
    "ros2 run turtlesim turtlesim_node"
)


_MISSING = (
    "rqt_graph: a program on this machine did not announce its topics in time, so the graph may be "
    "incomplete. Repeat the command."
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command. Return 0 if the graph was drawn, or 1 if no node was found.

    Decision 9 in docs/design.md explains the other exit codes.
    """
    prepare()
    protect_terminal()
    argv = list(sys.argv[1:] if arguments is None else arguments)
    for number in (signal.SIGTERM, signal.SIGHUP):
        # Exit as after Ctrl-C, so that the node leaves the graph properly.
        if signal.getsignal(number) == signal.SIG_DFL:
            signal.signal(number, signal.default_int_handler)
    try:
        if "_ARGCOMPLETE" not in os.environ and not any(_is_ours(word) for word in argv):
            hand_over("rqt_graph", "rqt_graph")
        options = _parse(argv)
        see_to_environment({"rclpy"})
        return _run(options)
    except GraderError as error:
        say(f"rqt_graph: {error}")
        return error.exit_code
    except KeyboardInterrupt:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # while Python exits, Ctrl-C would only print a traceback
        return 130
    except BrokenPipeError:
        # The reader of the output has exited, as in `rqt_graph | head`.
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        return 1


def _is_ours(word: str) -> bool:
    return word.partition("=")[0] in _OURS


def _parse(argv: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="rqt_graph",
        description="Show the running nodes with the topics that they publish and subscribe to.",
        epilog="Without --output and --text, the graph is live in a browser until Ctrl-C. If no browser is found, the "
        "graph is printed as text. Over ssh or with --port, the graph is served instead, and you open the page "
        "yourself. Example: rqt_graph --output graph.svg",
    )
    parser.add_argument(
        "-o", "--output", type=Path, metavar="FILE", help="write the graph to a file: graph.svg, graph.png or graph.dot"
    )
    parser.add_argument("--text", action="store_true", help="print the graph as text, even on a machine with a browser")
    parser.add_argument("--port", type=int, help="port of the page (default: the same as last time, or a free one)")
    parser.add_argument("--active", action="store_true", help="hide topics without a publisher or without a subscriber")
    parser.add_argument("--debug", action="store_true", help="also show tools, and topics such as /rosout and /clock")
    parser.add_argument(
        "--hidden", action="store_true", help='also show names that begin with "_", such as the topics of actions'
    )
    parser.add_argument("--all", action="store_true", help="show everything: --debug and --hidden")
    if "_ARGCOMPLETE" in os.environ:
        from argcomplete import autocomplete

        autocomplete(parser)
    options = parser.parse_args(argv)
    if options.output is not None:
        _check(options.output)
    return options


def _check(output: Path) -> None:
    if output.suffix not in _FORMATS:
        message = f"--output {output}: the name must end in .svg, .png or .dot."
        raise UsageError(message)
    if not output.absolute().parent.is_dir():
        message = f"--output {output}: the folder {output.absolute().parent} does not exist."
        raise UsageError(message)


def _run(options: argparse.Namespace) -> int:
    show = Show(debug=options.debug or options.all, hidden=options.hidden or options.all, dead_ends=not options.active)
    if options.output is None and not options.text and _shown_live(show, options.port):
        return 0
    # Import these modules here, because rclpy cannot be imported earlier.
    from grader.graph.discovery import cli_node, settle
    from grader.graph.endpoints import observe

    with cli_node(f"_rqt_graph_{os.getpid()}") as node:
        complete = settle(node)
        observed = observe(node)
    drawn = picture(observed.nodes, observed.ends, show)
    # Check the drawn nodes, since the daemon of the real ros2 is a node that is not shown.
    if not drawn.nodes:
        print(_NOTHING.format(domain=os.environ.get("ROS_DOMAIN_ID") or "0"), file=sys.stderr)
        return 1
    if not complete:
        say(_MISSING)
    if options.output is not None:
        _write(options.output, drawn)
    else:
        print(to_text(drawn, ascii_only=not sys.stdout.encoding.lower().startswith("utf")), end="")
    sys.stdout.flush()
    return 0


def _write(file: Path, drawn: Picture) -> None:
    dot = to_dot(drawn)
    kinds: dict[str, Format] = {".svg": "svg", ".png": "png"}
    content = render(dot, kinds[file.suffix]) if file.suffix in kinds else dot.encode()
    try:
        file.write_bytes(content)
    except OSError as error:
        message = f"{file} could not be written: {error.strerror}."
        raise UsageError(message) from error


def _shown_live(show: Show, port: int | None) -> bool:
    """Serve the graph on a page until Ctrl-C.

    Return False immediately if no browser can show the page, or if a library for the page is not installed.

    If no browser can be opened on this machine, the page is served only with --port or in a terminal over ssh. The user
    then opens the page.
    """
    from grader.view import browser

    elsewhere = not browser.there_is_one() and (port is not None or (browser.over_ssh() and sys.stdout.isatty()))
    if not browser.there_is_one() and not elsewhere:
        return False
    import asyncio

    from grader.view.address import listen
    from grader.view.launch import see_that_it_can_be_served

    try:
        see_that_it_can_be_served("the graph is printed as text instead")
    except MachineError as error:
        say(f"rqt_graph: {error}")
        return False
    from grader.view.page import Page

    place = listen("graph", port)

    async def serve() -> bool:
        return await Page(None, show, stays=elsewhere).serve(place)

    print(f"The graph, live until Ctrl-C: {place.address.url}", flush=True)
    if elsewhere:
        say(browser.from_elsewhere(place.address.port))
    shown = asyncio.run(serve())
    # From now on, Python handles Ctrl-C again.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    return shown


if __name__ == "__main__":
    sys.exit(main())
