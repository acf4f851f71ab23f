"""The verb `service find`: find the services of a type."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from grader.graph.graph_info import shown
from grader.ros import index
from grader.ros.failure import did_you_mean
from grader.ros2.completion import all_service_types, completes
from grader.ros2.graph_source import look

if TYPE_CHECKING:
    import argparse


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    completes(parser.add_argument("service_type", help="full type, such as std_srvs/srv/Empty"), all_service_types)
    parser.add_argument("-c", "--count-services", action="store_true", help="print only the number of services")
    parser.add_argument("--include-hidden-services", action="store_true", help="include hidden services")


def run(args: argparse.Namespace) -> int:
    """Print the sorted names of the services of the requested type, or their number. Return 0 even if there is none."""
    found = shown(look(args).services, all_of_them=args.include_hidden_services)
    names = [name for name, types in found if args.service_type in types]
    print(len(names)) if args.count_services else [print(name) for name in names]
    if not names and args.service_type not in index.all_interfaces("srv"):
        hint = did_you_mean(args.service_type, {name for _, types in found for name in types})
        if hint:
            print(hint, file=sys.stderr)
    return 0
