"""The verb `pkg create`: a new ament_python package, whose files are templates/ with names filled in."""

from __future__ import annotations

import getpass
import re
import subprocess
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape, quoteattr

from grader.ros.failure import Ros2Error

if TYPE_CHECKING:
    import argparse

_TEMPLATES = Path(__file__).with_name("templates")
LICENSES = (
    *("Apache-2.0", "BSL-1.0", "BSD-2.0", "BSD-2-Clause", "BSD-3-Clause"),
    *("GPL-3.0-only", "LGPL-3.0-only", "MIT", "MIT-0"),
)
"""The names that ROS 2's own tools know."""
_SYSTEMS_TEXTS = {"Apache-2.0": "Apache-2.0", "GPL-3.0-only": "GPL-3", "LGPL-3.0-only": "LGPL-3"}
_NAME = re.compile(r"[a-z][a-z0-9_]*")
_TAKEN = ("test", "resource")


def create(args: argparse.Namespace) -> int:
    """Write the package; nothing is written if anything is wrong with what was asked for.

    Raises:
        Ros2Error: the name or the folder cannot be used, or it is not an ament_python package.
    """
    name, node = args.package_name, args.node_name
    _check(args)
    folder = Path(args.destination_directory, name)
    shown = f"./{folder}" if not folder.is_absolute() else str(folder)
    if folder.exists():
        message = (
            f"\nAborted!\nThe directory already exists: {shown}\n"
            "Either remove the directory or choose a different destination directory or package name"
        )
        raise Ros2Error(message)
    maintainer = args.maintainer_name or getpass.getuser()
    email = args.maintainer_email or _email(maintainer)
    _tell(args, f"{maintainer} <{email}>")
    filled = {
        "name": name,
        "maintainer": repr(maintainer),
        "email": repr(email),
        "description": repr(args.description),
        "license": repr(args.license),
        "scripts": f"\n            '{node} = {name}.{node}:main'," if node else "",
    }
    try:
        _write(folder, shown, filled, _manifest(args, maintainer, email), node)
        licensed = _license(args.license, folder / "LICENSE", maintainer)
    except OSError as error:
        message = f"\nAborted!\n{error.filename or folder} could not be written: {error.strerror}"
        raise Ros2Error(message) from error
    if args.license not in LICENSES:
        known = "\n".join(LICENSES)
        print(
            f"\n[WARNING]: Unknown license '{args.license}'.  This has been set in the package.xml, but no LICENSE "
            f"file has been created.\nIt is recommended to use one of the ament license identifiers:\n{known}"
        )
    elif not licensed:
        print(f"\n[WARNING]: The text of the license '{args.license}' is not on this machine: no LICENSE file.")
    return 0


def _check(args: argparse.Namespace) -> None:
    if args.build_type != "ament_python":
        message = (
            f"\nAborted!\nHere packages are made with --build-type ament_python; a package of type {args.build_type} "
            "is written in C++, and needs a whole ROS 2."
        )
        raise Ros2Error(message)
    for what, value in (("package", args.package_name), ("node", args.node_name)):
        if value is not None and (not _NAME.fullmatch(value) or value in _TAKEN):
            message = (
                f"\nAborted!\nThe {what} name '{value}' cannot be used: it becomes the name of a Python module. "
                f"Lower-case letters, digits and _ were expected, a letter first, and not {' or '.join(_TAKEN)}."
            )
            raise Ros2Error(message)
    if not Path(args.destination_directory).is_dir():
        message = f"\nAborted!\nThere is no directory {args.destination_directory} to make the package in"
        raise Ros2Error(message)


def _tell(args: argparse.Namespace, maintainer: str) -> None:
    lines = [
        "going to create a new package",
        f"package name: {args.package_name}",
        f"destination directory: {Path(args.destination_directory).absolute().resolve()}",
        f"package format: {args.package_format}",
        "version: 0.0.0",
        f"description: {args.description}",
        f"maintainer: {[maintainer]}",
        f"licenses: {[args.license]}",
        f"build type: {args.build_type}",
        f"dependencies: {args.dependencies}",
    ]
    if args.node_name:
        lines.append(f"node_name: {args.node_name}")
    print("\n".join(lines))


def _write(folder: Path, shown: str, filled: dict[str, str], manifest: str, node: str | None) -> None:
    """Write the files, telling each."""
    name = filled["name"]

    def write(path: str, text: str) -> None:
        print(f"creating {shown}/{path}")
        (folder / path).write_text(text, encoding="utf-8")

    def make(path: str) -> None:
        print(f"creating folder {shown}/{path}".rstrip("/"))
        (folder / path).mkdir()

    def template(file: str) -> str:
        return Template((_TEMPLATES / f"{file}.in").read_text("utf-8")).substitute(filled)

    make("")
    write("package.xml", manifest)
    print("creating source folder")
    make(name)
    for file in ("setup.py", "setup.cfg"):
        write(file, template(file))
    make("resource")
    write(f"resource/{name}", "")
    write(f"{name}/__init__.py", "")
    make("test")
    for file in ("test_copyright.py", "test_flake8.py", "test_pep257.py"):
        write(f"test/{file}", template(file))
    if node:
        write(f"{name}/{node}.py", template("node.py"))


def _manifest(args: argparse.Namespace, maintainer: str, email: str) -> str:
    depends = "".join(f"  <depend>{escape(name)}</depend>\n" for name in args.dependencies)
    filled = {
        "name": args.package_name,
        "format": args.package_format,
        "description": escape(args.description),
        "maintainer": escape(maintainer),
        "email": quoteattr(email),
        "license": escape(args.license),
        "depends": f"{depends}\n" if depends else "",
    }
    return Template((_TEMPLATES / "package.xml.in").read_text("utf-8")).substitute(filled)


def _email(user: str) -> str:
    try:
        asked = subprocess.run(
            ["git", "config", "--get", "user.email"], capture_output=True, text=True, check=False, errors="replace"
        )
    except OSError:
        return f"{user}@todo.todo"
    return asked.stdout.strip() or f"{user}@todo.todo"


def _license(name: str, file: Path, holder: str) -> bool:
    """Write the text of a license, if there is one here; returns whether there is."""
    system = Path("/usr/share/common-licenses", _SYSTEMS_TEXTS.get(name, name))
    if name not in LICENSES:
        return False
    if name in _SYSTEMS_TEXTS and system.is_file():
        file.write_text(system.read_text("utf-8"), encoding="utf-8")
        return True
    own = _TEMPLATES / f"{name}.in"
    if not own.is_file():
        return False
    file.write_text(Template(own.read_text("utf-8")).substitute(holder=holder), encoding="utf-8")
    return True
