"""The group `interface`: what messages, services and actions consist of, and which there are.

Only files are read.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

from grader.ros import index
from grader.ros.failure import Ros2Error
from grader.ros2 import show

if TYPE_CHECKING:
    import argparse

_TITLES = {"msg": "Messages:", "srv": "Services:", "action": "Actions:"}


def add(group: argparse.ArgumentParser) -> None:
    """Add the verbs."""
    verbs = group.add_subparsers(title="Verbs", metavar="VERB")

    parser = verbs.add_parser("show", help="what an interface consists of")
    parser.add_argument("type", help="as in geometry_msgs/msg/Twist; - reads it from standard input").completer = _types  # type: ignore[attr-defined]
    parser.add_argument("--all-comments", action="store_true", help="those of nested types too")
    parser.add_argument("--no-comments", action="store_true", help="neither comments nor empty lines")
    parser.set_defaults(verb=_show)

    parser = verbs.add_parser("list", help="all interfaces, by kind")
    for kind, name in (("msg", "msgs"), ("srv", "srvs"), ("action", "actions")):
        parser.add_argument(f"-{kind[0]}", f"--only-{name}", dest="kinds", action="append_const", const=kind)
    parser.set_defaults(verb=_list)

    parser = verbs.add_parser("packages", help="the packages that have interfaces")
    for kind, name in (("msg", "msgs"), ("srv", "srvs"), ("action", "actions")):
        parser.add_argument(f"-{kind[0]}", f"--only-{name}", dest="kinds", action="append_const", const=kind)
    parser.set_defaults(verb=_packages)

    parser = verbs.add_parser("package", help="the interfaces of one package")
    parser.add_argument("package_name").completer = lambda **_: index.interface_packages()  # type: ignore[attr-defined]
    parser.set_defaults(verb=_package)


def _types(**_: Any) -> list[str]:  # noqa: ANN401
    return index.all_interfaces()


def _show(args: argparse.Namespace) -> int:
    name = args.type
    if name == "-":
        name = "" if sys.stdin.isatty() else sys.stdin.readline().strip()
        if not name:
            message = "Expected stdin: `ros2 topic type /turtle1/pose | ros2 interface show -`"
            raise Ros2Error(message)
    comments = not args.no_comments
    for line in show.lines(name, comments=comments, nested_comments=comments and args.all_comments):
        print(line)
    return 0


def _list(args: argparse.Namespace) -> int:
    for kind in args.kinds or index.KINDS:
        print(_TITLES[kind])
        for name in index.all_interfaces(kind):
            print(f"    {name}")
    return 0


def _packages(args: argparse.Namespace) -> int:
    kinds = set(args.kinds or index.KINDS)
    for package in index.interface_packages():
        if args.kinds is None or any(name.split("/")[1] in kinds for name in index.interfaces(package)):
            print(package)
    return 0


def _package(args: argparse.Namespace) -> int:
    for name in index.interfaces(args.package_name):
        print(name)
    return 0
