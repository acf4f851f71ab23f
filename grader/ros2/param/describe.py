"""The verb `param describe`: print the descriptions of parameters and their allowed values."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from grader.ros.failure import did_you_mean
from grader.ros2.param.options import add_name, add_node, add_timeout

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_node(parser)
    add_name(parser, "parameter_names", nargs="+")
    add_timeout(parser)


def run(args: argparse.Namespace) -> int:
    """Print the descriptions. The exit code is 0 even if one of the parameters is not declared.

    Raises:
        Ros2Error: the node does not exist or does not respond.
    """
    from grader.ros2.param.parameter_client import parameters_of

    with parameters_of(args) as parameters:
        found = parameters.describe(args.parameter_names)
        for descriptor in found:
            print(described(descriptor))
        if len(found) < len(args.parameter_names):
            known = parameters.names()
            for name in args.parameter_names:
                if name not in known:
                    text = f"Parameter '{name}' is not declared by {parameters.node_name}"
                    print(did_you_mean(name, known, text), file=sys.stderr)
    return 0


def described(descriptor: Any) -> str:  # noqa: ANN401
    """Return a descriptor as text."""
    from grader.ros2.param.parameter_client import type_name

    lines = [f"Parameter name: {descriptor.name}", f"  Type: {type_name(descriptor.type)}"]
    if descriptor.description:
        lines.append(f"  Description: {descriptor.description}")
    lines.append("  Constraints:")
    if descriptor.read_only:
        lines.append("    Read only: true")
    for limits in (*descriptor.floating_point_range, *descriptor.integer_range):
        lines += [f"    Min value: {limits.from_value}", f"    Max value: {limits.to_value}"]
        if limits.step:
            lines.append(f"    Step: {limits.step}")
    if descriptor.additional_constraints:
        lines.append(f"    Additional constraints: {descriptor.additional_constraints}")
    return "\n".join(lines)
