"""Mistakes with files: missing, empty, or in the wrong folder."""

from __future__ import annotations

from typing import TYPE_CHECKING

from grader.tests.operators.operator import Change, Make, Operator, Package, edited, replace

if TYPE_CHECKING:
    from random import Random

    from grader.checks.diagnosis import Diagnosis


def _without(path: str, look_at: str = "") -> Make:
    def make(package: Package, _: Random) -> Change | None:
        where = path.format(folder=package.folder, source=package.source)
        if where not in package.files:
            return None
        return Change({key: text for key, text in package.files.items() if key != where}, look_at or where)

    return make


def _moved(to: str) -> Make:
    def make(package: Package, _: Random) -> Change | None:
        if package.source.endswith("/__init__.py"):
            return None  # Without this file, its folder is not a package, which is another mistake.
        files = dict(package.files)
        text = files.pop(package.source)
        files[to.format(folder=package.folder, name=package.source.rpartition("/")[2].removesuffix(".py"))] = text
        return Change(files, "setup.py")

    return make


def _empty(package: Package, _: Random) -> Change:
    return edited(package, package.source, "")


def _place(name: str, make: Make, *says: Diagnosis) -> Operator:
    return Operator(name, make, frozenset(says))


OPERATORS = (
    _place("no-setup-py", _without("setup.py", "package.xml"), "setup-py-missing"),
    _place("no-package-xml", _without("package.xml", "setup.py"), "package-xml-missing"),
    _place("no-setup-cfg", _without("setup.cfg", "setup.py"), "setup-cfg"),
    _place("no-init", _without("{folder}/__init__.py", "setup.py"), "missing-init"),
    _place("no-marker", _without("resource/my_robot_controller", "setup.py"), "data-file-missing", "resource-marker"),
    _place("no-source", _without("{source}", "setup.py"), "entry-point-module"),
    _place("source-beside-setup-py", _moved("{name}.py"), "entry-point-module"),
    _place("source-renamed", _moved("{folder}/{name}_node.py"), "entry-point-module"),
    _place("source-without-ending", _moved("{folder}/{name}"), "entry-point-module"),
    _place("source-empty", _empty, "empty-file"),
    _place(
        "setup-cfg-elsewhere",
        replace(r"\$base/lib/my_robot_controller", "$base/lib/my_robot", file="setup.cfg"),
        "setup-cfg",
    ),
    _place(
        "setup-cfg-without-base", replace(r"\$base/lib/my_robot_controller", "$base/bin", file="setup.cfg"), "setup-cfg"
    ),
)
