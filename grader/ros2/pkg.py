"""The group `pkg`: which packages there are, what is in them, and making a new one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from grader.ros import index

if TYPE_CHECKING:
    import argparse


def add(group: argparse.ArgumentParser) -> None:
    """Add the verbs."""
    verbs = group.add_subparsers(title="Verbs", metavar="VERB")
    _add_create(verbs.add_parser("create", help="make a new package in this folder"))

    parser = verbs.add_parser("list", help="all packages")
    parser.set_defaults(verb=_list)

    parser = verbs.add_parser("prefix", help="the folder into which a package is installed")
    parser.add_argument("package_name").completer = _packages  # type: ignore[attr-defined]
    parser.add_argument("--share", action="store_true", help="its share folder instead")
    parser.set_defaults(verb=_prefix)

    parser = verbs.add_parser("executables", help="what `ros2 run` can start, of all packages or of one")
    parser.add_argument("package_name", nargs="?").completer = _packages  # type: ignore[attr-defined]
    parser.add_argument("--full-path", action="store_true", help="paths instead of names")
    parser.set_defaults(verb=_executables)


def _add_create(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package_name", help="lower-case letters, digits and _")
    parser.add_argument(
        "--build-type",
        default="ament_cmake",
        choices=["ament_python", "ament_cmake", "cmake"],
        help="ament_python here",
    )
    dependencies = parser.add_argument("--dependencies", nargs="+", default=[], metavar="PACKAGE")
    dependencies.completer = _packages  # type: ignore[attr-defined]
    parser.add_argument("--node-name", metavar="NAME", help="with a node's file and entry point of this name")
    parser.add_argument("--license", default="TODO: License declaration", help="as in Apache-2.0, MIT")
    parser.add_argument("--description", default="TODO: Package description")
    parser.add_argument("--destination-directory", default=".", metavar="DIR", help="where to make it (.)")
    parser.add_argument("--maintainer-name", metavar="NAME", help="default: who is logged in")
    parser.add_argument("--maintainer-email", metavar="EMAIL", help="default: that of git")
    parser.add_argument("--package-format", choices=["2", "3"], default="3")
    parser.set_defaults(verb=_create)


def _packages(**_: Any) -> list[str]:  # noqa: ANN401
    return list(index.packages())


def _create(args: argparse.Namespace) -> int:
    from grader.ros2 import pkg_create

    return pkg_create.create(args)


def _list(_: argparse.Namespace) -> int:
    for name in index.packages():
        print(name)
    return 0


def _prefix(args: argparse.Namespace) -> int:
    prefix = index.prefix_of(args.package_name, "Package not found")
    print(prefix / "share" / args.package_name if args.share else prefix)
    return 0


def _executables(args: argparse.Namespace) -> int:
    for package in [args.package_name] if args.package_name else index.packages():
        for path in index.executables(package, f"Package '{package}' not found"):
            print(path if args.full_path else f"{package} {path.name}")
    return 0
