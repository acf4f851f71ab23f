"""The verb `interface proto`: print a template with all fields of an interface and their default values."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.ros import index
from grader.ros2.completion import completes, interfaces

if TYPE_CHECKING:
    import argparse

_PARTS = {"msg": "", "srv": "Request", "action": "Goal"}
"""Maps each kind of interface to the part that a user fills in. A message has no parts."""


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    completes(parser.add_argument("type", help="full name, such as geometry_msgs/msg/Twist"), interfaces)
    parser.add_argument("--no-quotes", action="store_true", help="print the template without quotes")


def run(args: argparse.Namespace) -> int:
    """Print the template as YAML, in quotation marks unless --no-quotes is given.

    Raises:
        Ros2Error: no installed interface has this name.
    """
    from grader.ros import message_values, rendering

    index.interface_file(args.type)
    kind = args.type.split("/")[1]
    made = message_values.load_type(args.type, kind, text=f"The interface '{args.type}' cannot be imported")
    text = rendering.to_yaml((getattr(made, _PARTS[kind]) if _PARTS[kind] else made)(), rendering.Form(limit=None))
    print(text if args.no_quotes else f'"{text}"')
    return 0
