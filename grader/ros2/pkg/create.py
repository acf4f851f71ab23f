"""The verb `pkg create`: create a package with the files that its build type requires."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from grader.common import xdg
from grader.ros.failure import Ros2Error
from grader.ros2.completion import completes, packages
from grader.ros2.pkg.new_package import NewPackage

if TYPE_CHECKING:
    import argparse

_PYTHON_NAME = re.compile(r"[a-z][a-z0-9_]*")


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    parser.add_argument("package_name", help="name of the package: lower-case letters, digits and _")
    parser.add_argument(
        "--package-format",
        "--package_format",
        type=int,
        default=3,
        choices=[2, 3],
        help="format of package.xml (default: 3)",
    )
    parser.add_argument("--description", default="TODO: Package description", help="purpose of the package")
    parser.add_argument(
        "--license",
        default="TODO: License declaration",
        help="any string; '?' lists the known licenses; a LICENSE file is created if this machine has the text",
    )
    parser.add_argument("--destination-directory", default=".", help="create the package in this directory")
    parser.add_argument(
        "--build-type",
        default="ament_cmake",
        choices=["cmake", "ament_cmake", "ament_python"],
        help="use ament_python for a Python package (default: ament_cmake)",
    )
    needed = parser.add_argument("--dependencies", nargs="+", default=[], help="packages that the new package uses")
    completes(needed, packages)
    parser.add_argument("--maintainer-email", help="default: the address in git's settings, or NAME@todo.todo")
    parser.add_argument("--maintainer-name", default=xdg.user_name(), help="default: the user name")
    parser.add_argument("--node-name", help="also create an executable with this name")
    parser.add_argument("--library-name", help="also create a library with this name")


def run(args: argparse.Namespace) -> int:
    """Create the package.

    Raises:
        Ros2Error: the folder already exists or cannot be created, or a name is not allowed.
    """
    from grader.ros2.pkg import licenses, package_files

    if args.license == "?":
        print("\n".join(["Supported licenses:", *licenses.KNOWN]))
        return 0
    wanted = _wanted(args)
    _check(wanted)
    _tell(wanted, args.destination_directory)
    try:
        package_files.write(wanted)
        licensed = licenses.write(wanted.license, wanted.folder / "LICENSE", wanted.maintainer)
    except BrokenPipeError:
        raise  # the reader of the output has exited, so the folder is not the cause
    except OSError as error:
        message = f"\nAborted!\n{error.filename or wanted.folder} could not be written: {error.strerror}"
        raise Ros2Error(message) from error
    if wanted.license not in licenses.KNOWN:
        known = "\n".join(licenses.KNOWN)
        print(
            f"\n[WARNING]: Unknown license '{wanted.license}'.  This has been set in the package.xml, but no LICENSE "
            f"file has been created.\nIt is recommended to use one of the ament license identifiers:\n{known}"
        )
    sys.stdout.flush()
    if wanted.license in licenses.KNOWN and not licensed:
        print(
            f"This machine does not have the text of the license '{wanted.license}', so no LICENSE file was created.",
            file=sys.stderr,
        )
    for advice in _advice(wanted):
        print(advice, file=sys.stderr)
    return 0


def _wanted(args: argparse.Namespace) -> NewPackage:
    node = args.node_name
    if node and node == args.library_name:
        node = f"{node}_node"
        print("[WARNING] node name can not be equal to the library name", file=sys.stderr)
        print(f"[WARNING] renaming node to {node}", file=sys.stderr)
    folder = Path(args.destination_directory, args.package_name)
    return NewPackage(
        name=args.package_name,
        folder=folder,
        shown=os.path.join(args.destination_directory, args.package_name),  # noqa: PTH118 - Path drops "./"
        build_type=args.build_type,
        package_format=args.package_format,
        description=args.description,
        maintainer=args.maintainer_name,
        email=args.maintainer_email or _email() or f"{args.maintainer_name}@todo.todo",
        license=args.license,
        dependencies=tuple(args.dependencies),
        node=node or None,
        library=args.library_name or None,
    )


def _check(wanted: NewPackage) -> None:
    if wanted.build_type == "ament_python" and wanted.name == "test":
        message = "Aborted since 'ament_python' packages can't be named 'test'. Please choose a different package name."
        raise Ros2Error(message)
    if wanted.folder.exists():
        message = (
            f"\nAborted!\nThe directory already exists: {wanted.shown}\n"
            "Either remove the directory or choose a different destination directory or package name"
        )
        raise Ros2Error(message)
    for what, value in (("package", wanted.name), ("node", wanted.node), ("library", wanted.library)):
        if value is not None and (not value or "/" in value or "\0" in value or value in (".", "..")):
            message = f"\nAborted!\nThe {what} name '{value}' cannot be the name of a file."
            raise Ros2Error(message)


def _advice(wanted: NewPackage) -> list[str]:
    """Return warnings about choices that can cause problems."""
    advice = []
    names = (("package", wanted.name), ("node", wanted.node), ("library", wanted.library))
    odd = [f"{what} name '{value}'" for what, value in names if value is not None and not _PYTHON_NAME.fullmatch(value)]
    if odd:
        advice.append(
            f"The {' and the '.join(odd)} can cause problems. Begin with a letter, and use only lower-case letters, "
            "digits and _. Python cannot import a name with a character such as -, and colcon warns about upper-case "
            "letters in the name of a package."
        )
    if wanted.build_type != "ament_python":
        advice.append(
            f"The build type {wanted.build_type} is for packages in C++. To build the package, you need CMake and a "
            "C++ compiler. A node in C++ also needs rclcpp, which is part of a full ROS 2. For Python, use "
            "--build-type ament_python."
        )
    return advice


def _tell(wanted: NewPackage, destination: str) -> None:
    lines = [
        "going to create a new package",
        f"package name: {wanted.name}",
        f"destination directory: {Path(destination).absolute().resolve()}",
        f"package format: {wanted.package_format}",
        "version: 0.0.0",
        f"description: {wanted.description}",
        f"maintainer: {[f'{wanted.maintainer} <{wanted.email}>']}",
        f"licenses: {[wanted.license]}",
        f"build type: {wanted.build_type}",
        f"dependencies: {list(wanted.dependencies)}",
    ]
    lines += [f"node_name: {wanted.node}"] if wanted.node else []
    lines += [f"library_name: {wanted.library}"] if wanted.library else []
    print("\n".join(lines))


def _email() -> str:
    try:
        answer = subprocess.run(
            ["git", "config", "user.email"], capture_output=True, text=True, check=False, errors="replace"
        )
    except OSError:
        return ""
    return answer.stdout.strip()
