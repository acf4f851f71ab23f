"""The verb `topic echo`: print the messages on a topic."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

from grader.ros import message_values
from grader.ros.failure import Ros2Error
from grader.ros.rendering import Form, is_message, to_csv, to_yaml
from grader.ros2 import qos
from grader.ros2.completion import completes, topic_types, topics
from grader.ros2.format_options import add_form, form_of
from grader.ros2.options import add_look, positive_float

if TYPE_CHECKING:
    import argparse
    from collections.abc import Callable

    from rclpy.node import Node


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_look(parser)
    completes(parser.add_argument("topic_name", help="name of the topic, such as /turtle1/pose"), topics)
    kind = parser.add_argument(
        "message_type", nargs="?", help="type of the topic, required if the topic does not exist"
    )
    completes(kind, topic_types)
    qos.add_qos(parser, "sensor_data")
    parser.add_argument(
        "--csv", action="store_true", help="print each message on one line, with commas between the values"
    )
    parser.add_argument("--field", action="append", help="print only this part, such as linear.x; may be repeated")
    add_form(parser)
    parser.add_argument("--no-lost-messages", action="store_true", help="do not report lost messages")
    parser.add_argument("--raw", action="store_true", help="print the bytes of the messages")
    parser.add_argument(
        "--filter",
        dest="filter_expr",
        help="print only the messages m for which this Python expression is true (with one --field, m is that field)",
    )
    parser.add_argument("--once", action="store_true", help="print one message and exit")
    parser.add_argument("--timeout", metavar="N", type=positive_float, help="exit after N seconds")
    parser.add_argument(
        "--include-message-info", "-i", action="store_true", help="also print time stamps and sequence numbers"
    )


def run(args: argparse.Namespace) -> int:
    """Print messages until Ctrl-C, or until a limit set by the options is reached.

    Raises:
        Ros2Error: the type of the topic cannot be determined or does not have the field, or the filter is invalid.
    """
    from grader.graph.discovery import cli_node, spin_until
    from grader.ros2.topic import topic_lookup
    from grader.ros2.topic.subscribe import chosen_qos, subscribe

    for field in args.field or ():
        if not field.strip("."):
            message = f"Invalid field value '{field}'"
            raise Ros2Error(message)
    printer = Printer(args)
    with cli_node(use_sim_time=args.use_sim_time) as node:
        topic = topic_lookup.expanded(node, args.topic_name)
        topic_lookup.find(node, topic, args)
        profile = chosen_qos(node, topic, args)
        made = _class(node, topic, args)
        for field in args.field or () if not args.raw else ():
            message_values.field(made(), field, complete=False)
        subscribe(node, made, topic, printer.show, profile, args)
        end = time.monotonic() + args.timeout if args.timeout else None
        spin_until(node, lambda: args.once and printer.printed > 0, end - time.monotonic() if end else None)
    return 0


def _class(node: Node, topic: str, args: argparse.Namespace) -> Any:  # noqa: ANN401
    from grader.ros2.topic import topic_lookup

    if args.message_type:
        return message_values.load_type(args.message_type, "msg")
    made = topic_lookup.type_of(node, topic, args.topic_name)
    if made is None:
        topic_lookup.not_published(args.topic_name)
        raise Ros2Error(topic_lookup.nearest_topic(node, topic, "Could not determine the type for the passed topic"))
    return made


def matching(expression: str) -> Callable[[Any], bool]:
    """Return a function that evaluates a Python expression with the message as `m`.

    The returned function raises Ros2Error if the expression fails for a message.

    Raises:
        Ros2Error: the string is not a Python expression.
    """
    try:
        code = compile(expression, "<filter>", "eval")
    except (SyntaxError, ValueError) as error:
        message = f"The filter is not a Python expression: {error}"
        raise Ros2Error(message) from error

    def holds(m: Any) -> bool:  # noqa: ANN401
        try:
            return bool(eval(code, {"m": m}))
        except Exception as error:
            message = f"The filter '{expression}' failed: {type(error).__name__}: {error}"
            raise Ros2Error(message) from error

    return holds


class Printer:
    """Prints messages as specified by the options. `printed` is the number of printed messages."""

    def __init__(self, args: argparse.Namespace) -> None:
        self.printed = 0
        self._args = args
        self._form: Form = form_of(args)
        self._wanted = matching(args.filter_expr) if args.filter_expr else None

    def show(self, message: Any, info: dict[str, Any]) -> None:  # noqa: ANN401
        """Print a message. `info` is what rclpy reports about the message, such as its time stamps."""
        if self._args.once and self.printed:
            return
        parts = [message_values.field(message, field) for field in self._args.field or ()] or [message]
        if self._wanted is not None and not self._wanted(parts[0] if len(parts) == 1 else message):
            return
        self.printed += 1
        print(self._text(parts, info if self._args.include_message_info else {}), end="", flush=True)

    def _text(self, parts: list[Any], info: dict[str, Any]) -> str:
        if not any(map(is_message, parts)) and not (self._args.csv and len(parts) > 1):
            # Print the value as Python does. With --raw, it is the bytes of a message.
            before = f"---Got new message, message info:---\n{info}\n---Message data:---\n" if info else ""
            return before + "".join(f"{part}\n---\n" for part in parts)
        if self._args.csv:
            return ",".join([*map(str, info.values()), *(to_csv(part, self._form) for part in parts)]) + "\n"
        import yaml

        before = yaml.safe_dump(info) + "---\n" if info else ""
        texts = (to_yaml(part, self._form) if is_message(part) else f"{part}\n" for part in parts)
        return before + "".join(f"{text}---\n" for text in texts)
