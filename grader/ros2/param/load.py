"""The verb `param load`: set the parameters of a node from a parameter file."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from grader.ros.failure import Ros2Error
from grader.ros2.given_file import why_not
from grader.ros2.param.options import add_node, add_timeout

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    add_node(parser)
    parser.add_argument("parameter_file", help="a file in the format of `ros2 param dump`")
    parser.add_argument(
        "--no-use-wildcard", action="store_true", help="ignore the parameters under '/**', which apply to every node"
    )
    add_timeout(parser)


def run(args: argparse.Namespace) -> int:
    """Set all parameters. Return 0 even if the node rejects some of the parameters.

    Raises:
        Ros2Error: the node does not exist or does not respond, the file cannot be read, or it is not a parameter file.
    """
    from grader.ros2.param.parameter_client import parameters_of

    with parameters_of(args) as parameters:
        wanted = read(args.parameter_file, use_wildcard=not args.no_use_wildcard)
        for one, result in zip(wanted, parameters.set(wanted), strict=True):
            reason = f": {result.reason}" if result.reason else ""
            if result.successful:
                print(f"Set parameter {one.name} successful{reason}")
            else:
                print(f"Set parameter {one.name} failed{reason}", file=sys.stderr)
    return 0


def read(file: str, *, use_wildcard: bool) -> list[Any]:
    """Return the parameters (rcl_interfaces/msg/Parameter) in a file. `use_wildcard` includes those under '/**'.

    Raises:
        Ros2Error: the file cannot be read, or it is not a parameter file.
    """
    why = why_not(Path(file), piped=True)
    if why:
        message = f"The parameter file {file} cannot be read: {why}"
        raise Ros2Error(message)
    import yaml
    from rclpy.parameter import parameter_dict_from_yaml_file

    try:
        return list(parameter_dict_from_yaml_file(file, use_wildcard).values())
    except OSError as error:
        message = f"The parameter file {file} cannot be read: {error.strerror}"
    except (yaml.YAMLError, AssertionError, AttributeError, TypeError, ValueError, RecursionError) as error:
        message = f"The file {file} is not a parameter file in YAML: {' '.join(str(error).split())}"
    except RuntimeError as error:
        message = str(error)
    raise Ros2Error(message)
