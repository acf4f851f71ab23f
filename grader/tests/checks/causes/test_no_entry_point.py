"""The reasons why the exercise's executable is missing or cannot start."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.outcome import Finding, Status
from grader.checks.subjects.building import BUILDS
from grader.checks.subjects.entry_point import ENTRY_POINT
from grader.tests.checks.made import BUILD, NODE, NODE_FILE, SETUP_PY, evidence, finding, submission

if TYPE_CHECKING:
    from grader.colcon.build import Build

POINT = '            "draw_circle = my_robot_controller.draw_circle:main",\n'
NOTHING = replace(BUILD, executables=(), entry_points={})
OTHER = "my_robot_controller/circle.py"
Files = dict[str, str | bytes | None]


def found(files: Files, build: Build = NOTHING) -> Finding:
    return finding("entry-point", evidence(package=submission(files), build=build))


def setup_py(instead: str, more: str = "") -> Files:
    """Return setup.py with this line in place of the entry point, and with more arguments of setup()."""
    return {"setup.py": SETUP_PY.replace(POINT, instead).replace("    entry_points=", f"{more}    entry_points=")}


@pytest.mark.parametrize(
    ("files", "diagnosis", "where", "words"),
    [
        (setup_py(""), "entry-point-missing", "setup.py:13", f"{NODE_FILE} exists, but"),
        ({**setup_py(""), NODE_FILE: None, OTHER: NODE}, "entry-point-missing", "setup.py:13", f"{OTHER} exists, but"),
        (
            {**setup_py(""), NODE_FILE: None},
            "entry-point-missing",
            "setup.py:13",
            "setup.py has no entry point with this name.",
        ),
        (
            {**setup_py('            "go = my_robot_controller.circle:main",\n'), NODE_FILE: None, OTHER: NODE},
            "entry-point-missing",
            "setup.py:13",
            "setup.py has no entry point with this name.",
        ),
        (
            setup_py('            "a = b.c:main" "draw_circle = my_robot_controller.draw_circle:main",\n'),
            "entry-point-comma",
            "setup.py:14",
            "This string contains more than one entry point. Write one string for each, with a comma after it.",
        ),
        (
            setup_py(f"            # {POINT.strip()}\n"),
            "entry-point-commented",
            "setup.py:14",
            "The entry point is in a comment",
        ),
        (
            setup_py("", f"    tests_require=[\n{POINT}    ],\n"),
            "entry-point-elsewhere",
            "setup.py:13",
            "The entry point is not in the list console_scripts.",
        ),
        (
            {},
            "entry-point-missing",
            "setup.py:14",
            "setup.py contains this entry point, but the build did not install it.",
        ),
        ({"setup.py": None}, "entry-point-missing", "setup.py", f"{NODE_FILE} exists, but"),
        ({"setup.py": "setup(\n"}, "entry-point-missing", "setup.py", f"{NODE_FILE} exists, but"),
        ({"setup.py": "print(3)\n"}, "entry-point-missing", "setup.py", f"{NODE_FILE} exists, but"),
    ],
)
def test_what_setup_py_has_instead_is_reported(files: Files, diagnosis: str, where: str, words: str) -> None:
    got = found(files)
    assert (got.diagnosis, str(got.where)) == (diagnosis, where)
    assert got.cause.startswith(words)


def test_another_group_is_shown_at_its_line() -> None:
    other = SETUP_PY.replace("console_scripts", "console_script")
    assert [found({"setup.py": text}).diagnosis for text in (other, other.replace(POINT, ""))] == [
        "entry-point-group"
    ] * 2
    assert [str(found({"setup.py": text}).where) for text in (other, other.replace(POINT, ""))] == ["setup.py:13"] * 2
    words = 'entry_points has the group "console_script". Executables belong in the group console_scripts.'
    assert found({"setup.py": other}).cause == words
    both = other.replace("    },", '        "console_scripts": [],\n    },')
    assert "has the group" not in found({"setup.py": both}).cause


def test_only_a_comment_with_the_entry_point_counts_as_commented_out() -> None:
    for comment in ("draw_circle is to come", "x = draw_circle", "draw_circle_2 = my_robot_controller.a:main"):
        assert found(setup_py(f"            # {comment}\n")).diagnosis == "entry-point-missing"
    assert found(setup_py('            "# draw_circle = in a text",\n')).diagnosis != "entry-point-commented"
    assert found(setup_py("            # draw_circle =\n")).diagnosis == "entry-point-commented"
    twice = "            # draw_circle = my_robot_controller.draw_circle:main = x\n"
    assert found(setup_py(twice)).diagnosis == "entry-point-commented"


@pytest.mark.parametrize(
    "build", [replace(NOTHING, entry_points={"draw_cirle": "a.b:c"}), replace(NOTHING, executables=("draw_cirle",))]
)
def test_an_executable_of_nearly_that_name_is_named(build: Build) -> None:
    got = found(setup_py(POINT.replace("draw_circle =", "draw_cirle =")), build)
    assert (got.diagnosis, str(got.where)) == ("entry-point-name", "setup.py:14")
    assert got.observed == "There is no executable draw_circle, but there is draw_cirle."


@pytest.mark.parametrize(
    ("name", "module", "node", "misspelt"),
    [
        ("draw_square", "draw_square", "draw_square", False),
        ("draw_square", "draw_square", "draw_circle", True),
        ("draw_square", "square", "draw_square", True),
        ("draw_cirle", "draw_cirle", "draw_square", True),
        ("circle", "circle", "draw_square", True),
        ("go_draw_circle", "go_draw_circle", "draw_square", True),
    ],
)
def test_a_complete_executable_of_another_name_is_not_a_misspelling(
    name: str, module: str, node: str, *, misspelt: bool
) -> None:
    build = replace(NOTHING, executables=(name,), entry_points={name: f"my_robot_controller.{module}:main"})
    files: Files = {
        **setup_py(f'            "{name} = my_robot_controller.{module}:main",\n'),
        NODE_FILE: None,
        f"my_robot_controller/{module}.py": NODE.replace('"draw_circle"', f'"{node}"'),
    }
    got = found(files, build)
    words = "Compare the two names letter by letter." if misspelt else "setup.py has no entry point with this name."
    assert (words in got.cause, "letter by letter" in got.cause) == (True, misspelt)


SCRIPT = replace(BUILD, entry_points={})


@pytest.mark.parametrize(
    ("files", "diagnosis", "where", "words"),
    [
        (
            {"scripts/draw_circle": "#!/usr/bin/env python3\nprint(1)\n"},
            "script-for-entry-point",
            "scripts/draw_circle:1",
            "scripts/draw_circle is installed as a script. Use an entry point that names a function in a module.",
        ),
        (
            {"scripts/draw_circle": "import rclpy\nprint(1)\n"},
            "script-shebang",
            "scripts/draw_circle:1",
            'scripts/draw_circle is installed as a script, and its first line, "import rclpy", does not start Python.',
        ),
        ({"scripts/draw_circle": "#!/bin/sh\necho python\n"}, "script-shebang", "scripts/draw_circle:1", '"#!/bin/sh"'),
        (
            {"scripts/draw_circle": "#!/usr/bin/python\r\n1\r\n"},
            "script-shebang",
            "scripts/draw_circle:1",
            '"#!/usr/bin/python", has a Windows line ending and does not start Python.',
        ),
        ({"draw_circle": "python3\n"}, "script-shebang", "draw_circle:1", '"python3"'),
        ({}, "script-shebang", f"{NODE_FILE}:1", '"import rclpy"'),
        ({NODE_FILE: None}, "entry-point-missing", "setup.py:13", ""),
    ],
)
def test_a_script_is_no_entry_point(files: Files, diagnosis: str, where: str, words: str) -> None:
    got = found({**setup_py(""), **files}, SCRIPT)
    assert (got.diagnosis, str(got.where)) == (diagnosis, where)
    assert words in got.cause
    assert got.observed == "The executable draw_circle is not an entry point."
    without = found({**setup_py(""), **files})
    assert without.observed == "The package has no executable draw_circle."
    assert "is installed as a script" not in without.cause


def leads_to(target: str) -> Build:
    return replace(BUILD, entry_points={"draw_circle": target})


@pytest.mark.parametrize(
    ("target", "diagnosis", "cause"),
    [
        (
            "my_robot_controller.draw_cirle:main",
            "entry-point-module",
            "A similar module exists: my_robot_controller.draw_circle.",
        ),
        ("elsewhere.quaff:main", "entry-point-module", "Compare the module name with the names of your files."),
        (
            "draw_circle:main",
            "entry-point-module",
            "Write the folder first, then a dot, then the file name without .py.",
        ),
        ("my_robot:main", "entry-point-module", "Write the folder first, then a dot, then the file name without .py."),
        ("my_robot_controller.draw_circle.py:main", "entry-point-py", "Write the module name without the ending .py."),
        ("my_robot_controller.draw_circle:mian", "entry-point-function", "The file has a function main."),
        (
            "my_robot_controller.draw_circle:send_it",
            "entry-point-function",
            "The file has a function main.",
        ),
        ("my_robot_controller.draw_circle:", "entry-point-no-function", "After the module, write a colon"),
    ],
)
def test_an_entry_point_that_leads_nowhere_is_explained_by_the_files(target: str, diagnosis: str, cause: str) -> None:
    got = found({}, leads_to(target))
    assert (got.diagnosis, str(got.where)) == (diagnosis, "setup.py:14")
    assert got.cause.startswith(cause)
    assert "draw_circle names" in got.observed


MODULE = "my_robot_controller.draw_circle"


@pytest.mark.parametrize(
    ("file", "target", "words"),
    [
        ("my_robot_controller/draw_circle_node.py", MODULE, f"A similar module exists: {MODULE}_node."),
        ("my_robot_controller/draw_circle.py", "my_robt_controller.draw_circle", f"A similar module exists: {MODULE}."),
        ("my_robot_controller/pose/__init__.py", "my_robot_controller.pos", "exists: my_robot_controller.pose."),
        ("my_robot_controller/my_first_node.py", MODULE, "Compare the module name with the names of your files."),
        ("other/draw_circle.py", MODULE, "Compare the module name with the names of your files."),
        (
            "my_robot_controller/draw_circle",
            MODULE,
            "There is a file my_robot_controller/draw_circle, but",
        ),
        ("my_robot_controller/draw_circle.py.txt", MODULE, "the name of a Python file must end with .py."),
        ("my_robot_controller/draw_circle.md", MODULE, "Compare the module name with the names of your files."),
    ],
)
def test_a_module_is_similar_only_if_its_folder_and_its_own_name_are(file: str, target: str, words: str) -> None:
    got = found({NODE_FILE: None, file: NODE}, leads_to(f"{target}:main"))
    assert (got.diagnosis, str(got.where)) == ("entry-point-module", "setup.py:14")
    assert words in got.cause


def test_a_module_that_is_neither_installed_nor_linked_is_reported() -> None:
    bare = replace(BUILD, installed=("share/my_robot_controller/package.xml",))
    got = found({}, bare)
    assert (got.diagnosis, str(got.where)) == ("module-not-installed", "setup.py:14")
    link = "lib/python3.11/site-packages/my-robot-controller.egg-link"
    assert found({}, replace(bare, installed=(link,))).status is Status.PASSED


@pytest.mark.parametrize(
    ("text", "diagnosis", "line"),
    [
        ("", "empty-file", ""),
        ("# nothing yet\n", "empty-file", ""),
        ("pass\n", "entry-point-function", None),
        ('"""Only this."""\n', "entry-point-function", None),
        ("import rclpy\nnode = rclpy.init()\nrclpy.spin(node)\n", "top-level-code", ":2"),
        ("import rclpy\ndef mian():\n    rclpy.init()\n", "entry-point-function", None),
        ("import rclpy\nclass A:\n    def main(self):\n        pass\nrclpy.init()\n", "main-in-class", ":3"),
        ("main: int = 7\n", "entry-point-not-callable", ":1"),
        ("def main():\n    pass\nmain = [1]\n", "entry-point-not-callable", ":3"),
        ("(main, other) = 1, 2\n", "entry-point-not-callable", ":1"),
    ],
)
def test_a_file_without_the_function_is_shown_what_it_has(text: str, diagnosis: str, line: str | None) -> None:
    got = found({NODE_FILE: text}, BUILD)
    assert (got.diagnosis, str(got.where)) == (diagnosis, "setup.py:14" if line is None else f"{NODE_FILE}{line}")


@pytest.mark.parametrize(
    "text",
    ["main: object = print\n", "try:\n    pass\nfinally:\n    def main():\n        pass\n", "def main(): pass\n"],
)
def test_an_entry_point_may_lead_to_anything_callable(text: str) -> None:
    assert found({NODE_FILE: text}, BUILD).status is Status.PASSED


def test_a_file_that_is_too_large_to_be_read_fails() -> None:
    got = found({NODE_FILE: b"#" * 500_000}, BUILD)
    assert (got.status, got.diagnosis) == (Status.FAILED, "unreadable")
    assert "too large to be read: more than 400 kB" in got.observed


@pytest.mark.parametrize(
    ("files", "reported"),
    [
        ({}, []),
        ({NODE_FILE: "def main(\n"}, ["entry-point"]),
        ({NODE_FILE: "def main(\n", **setup_py("")}, []),
        ({NODE_FILE: "def main(\n", **setup_py('            "draw_circle = nothing",\n')}, []),
        ({NODE_FILE: None, **setup_py(POINT)}, []),
        ({NODE_FILE: "def main(\n", "setup.py": None}, ["build"]),
    ],
)
def test_a_module_that_python_cannot_read_is_known_before_anything_is_built(files: Files, reported: list[str]) -> None:
    given = evidence(package=submission(files), build=None)
    early = {"entry-point": ENTRY_POINT.judge_early(given, {}), "build": BUILDS.judge_early(given, {})}
    assert [name for name, finding in early.items() if finding is not None] == reported
