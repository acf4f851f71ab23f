"""Create the folders and files of a new package from templates/, and print the name of each of them."""

from __future__ import annotations

import re
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape, quoteattr

if TYPE_CHECKING:
    from grader.ros2.pkg.new_package import NewPackage

_TEMPLATES = Path(__file__).parents[1] / "templates"
_TEST_DEPENDS = {
    "ament_cmake": ("ament_lint_auto", "ament_lint_common"),
    "ament_python": ("ament_copyright", "ament_flake8", "ament_pep257", "python3-pytest"),
}


def write(wanted: NewPackage) -> None:
    """Create the folder and all files except LICENSE.

    Raises:
        OSError: a file could not be written.
    """
    made = _Files(wanted)
    made.folder("")
    made.file("package.xml", _manifest(wanted))
    if wanted.build_type == "ament_python":
        _write_python(wanted, made)
    else:
        _write_cmake(wanted, made)


class _Files:
    """Creates folders and files in the folder of the package, and prints their names."""

    def __init__(self, wanted: NewPackage) -> None:
        self._wanted = wanted
        self._filled = {
            "name": wanted.name,
            "quoted": repr(wanted.name),
            "NAME": _macro(wanted.name),
            "maintainer": repr(wanted.maintainer),
            "email": repr(wanted.email),
            "description": repr(wanted.description),
            "license": repr(wanted.license),
            "scripts": f"\n            {f'{wanted.node} = {wanted.name}.{wanted.node}:main'!r}," if wanted.node else "",
        }

    def folder(self, path: str) -> None:
        print(f"creating folder {self._wanted.shown}/{path}".rstrip("/"))
        (self._wanted.folder / path).mkdir(parents=True)

    def file(self, path: str, text: str = "") -> None:
        print(f"creating {self._wanted.shown}/{path}")
        (self._wanted.folder / path).write_text(text, encoding="utf-8")

    def filled(self, path: str, template: str, **more: str) -> None:
        text = (_TEMPLATES / f"{template}.in").read_text("utf-8")
        self.file(path, Template(text).substitute(self._filled, **more))


def _macro(name: str) -> str:
    """Convert a name to a C++ macro name."""
    return "".join(char if char.isalnum() else "_" for char in name).upper()


def _write_python(wanted: NewPackage, made: _Files) -> None:
    name = wanted.name
    print("creating source folder")
    made.folder(name)
    made.filled("setup.py", "setup.py")
    made.filled("setup.cfg", "setup.cfg")
    made.folder("resource")
    made.file(f"resource/{name}")
    made.file(f"{name}/__init__.py")
    made.folder("test")
    for file in ("test_copyright.py", "test_flake8.py", "test_pep257.py"):
        made.filled(f"test/{file}", file)
    if wanted.node:
        made.filled(f"{name}/{wanted.node}.py", "node.py")
    if wanted.library:
        made.folder(f"{name}/{wanted.library}")
        made.file(f"{name}/{wanted.library}/__init__.py")


def _write_cmake(wanted: NewPackage, made: _Files) -> None:
    name, library = wanted.name, wanted.library
    print("creating source and include folder")
    made.folder("src")
    made.folder(f"include/{name}")
    made.file("CMakeLists.txt", _cmake_lists(wanted))
    if wanted.build_type == "cmake":
        made.filled(f"{name}Config.cmake.in", "Config.cmake.in")
        made.filled(f"{name}ConfigVersion.cmake.in", "ConfigVersion.cmake.in")
    if wanted.node:
        made.filled(f"src/{wanted.node}.cpp", "main.cpp")
    if library:
        names = {
            "library": library,
            "LIBRARY": _macro(library),
            "class_name": library.title().replace("_", ""),
            "namespace": re.sub(r"\W", "_", name),
        }
        made.filled(f"include/{name}/{library}.hpp", "library.hpp", **names)
        made.filled(f"src/{library}.cpp", "library.cpp", **names)
        made.filled(f"include/{name}/visibility_control.h", "visibility_control.h")


def _cmake_lists(wanted: NewPackage) -> str:
    """Return the content of CMakeLists.txt. The parts of the file are in the order that CMake requires."""
    ament = wanted.build_type == "ament_cmake"
    tools = (["ament_cmake", "ament_cmake_ros"] if wanted.library else ["ament_cmake"]) if ament else []
    filled = {
        "name": wanted.name,
        "NAME": _macro(wanted.name),
        "node": wanted.node or "",
        "library": wanted.library or "",
        "found": "".join(f"find_package({one} REQUIRED)\n" for one in [*tools, *wanted.dependencies]) or "# (none)\n",
        "dependencies": "".join(f" {one}" for one in wanted.dependencies),
    }
    kind = "ament" if ament else "cmake"
    parts = [f"{kind}_begin"]
    parts += [f"{kind}_library"] if wanted.library else []
    parts += [f"{kind}_node"] if wanted.node else []
    parts += ["cmake_node_library"] if wanted.node and wanted.library else []
    parts += [f"{kind}_end_library"] if wanted.library else []
    parts += [f"{kind}_end"]
    texts = (Template((_TEMPLATES / "cmake" / f"{part}.in").read_text("utf-8")).substitute(filled) for part in parts)
    return "\n".join(texts).replace("\n\n\n", "\n\n")


def _manifest(wanted: NewPackage) -> str:
    tool = {"ament_cmake": "ament_cmake_ros" if wanted.library else "ament_cmake"}.get(wanted.build_type)
    groups = (
        ("buildtool_depend", [tool] if tool else []),
        ("depend", wanted.dependencies),
        ("test_depend", _TEST_DEPENDS.get(wanted.build_type, ())),
    )
    blocks = ["".join(f"  <{tag}>{escape(one)}</{tag}>\n" for one in names) for tag, names in groups if names]
    filled = {
        "name": escape(wanted.name),
        "format": str(wanted.package_format),
        "description": escape(wanted.description),
        "maintainer": escape(wanted.maintainer),
        "email": quoteattr(wanted.email),
        "license": escape(wanted.license),
        "build_type": wanted.build_type,
        "depends": "".join(f"{block}\n" for block in blocks),
    }
    return Template((_TEMPLATES / "package.xml.in").read_text("utf-8")).substitute(filled)
