"""The verb `param set`: set a parameter."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros2.param.options import add_name, add_node, add_timeout

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_node(parser)
    add_name(parser)
    parser.add_argument("value", help="the value in YAML: 150, 1.5, true, text, [1, 2]")
    add_timeout(parser)


def run(args: argparse.Namespace) -> int:
    """Set the parameter. Return 0 even if the node rejects the value.

    Raises:
        Ros2Error: the node does not exist or does not respond, or the value cannot be read as YAML.
    """
    from rcl_interfaces.msg import Parameter

    from grader.ros2.param.parameter_client import parameters_of

    with parameters_of(args) as parameters:
        wanted = Parameter(name=args.parameter_name, value=value_of(args.value))
        report(parameters, wanted, "Set parameter successful", "Setting parameter failed")
    return 0


def value_of(text: str) -> Any:  # noqa: ANN401
    """Convert a YAML string to a ParameterValue.

    Raises:
        Ros2Error: the string cannot be read as YAML.
    """
    import yaml
    from rclpy.parameter import get_parameter_value

    try:
        return get_parameter_value(text)
    except (yaml.YAMLError, AssertionError, TypeError, ValueError, RecursionError) as error:
        message = f"The value cannot be read: {text}"
        raise Ros2Error(message) from error


def report(parameters: Any, wanted: Any, done: str, failed: str) -> None:  # noqa: ANN401
    """Set a parameter. Print `done`, or print `failed` to standard error, followed by the node's reason, if any."""
    result = parameters.set([wanted])[0]
    reason = f": {result.reason}" if result.reason else ""
    if result.successful:
        print(f"{done}{reason}")
        return
    print(f"{failed}{reason}", file=sys.stderr)
    known = parameters.names()
    hint = did_you_mean(wanted.name, known) if wanted.name not in known else ""
    if hint:
        print(hint, file=sys.stderr)
