"""The check of the entry point, and the causes of invalid entry points."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.checks.outcome import Status
from grader.tests.checks.changed import INIT, NOTHING, POINT, of, setup_py
from grader.tests.checks.made import BUILD, NODE, NODE_FILE
from grader.tests.checks.told import told

if TYPE_CHECKING:
    from grader.colcon.build import Build
    from grader.tests.checks.changed import Files


@pytest.mark.parametrize(
    ("text", "diagnosis"),
    [
        ("draw_circle", "entry-point-no-function"),
        ("draw_circle = a b:main", "entry-point-format"),
        ("draw_circle = a/b.py:main", "entry-point-slash"),
        ("a = b:c d = e:f", "entry-point-comma"),
    ],
)
def test_a_text_that_is_no_entry_point_is_explained_by_its_signs(text: str, diagnosis: str) -> None:
    found = of("build", setup_py(POINT, text), replace(NOTHING, exit_code=1))
    assert (found.diagnosis, str(found.where)) == (diagnosis, "setup.py:14")


def test_a_node_under_another_file_name_that_no_entry_point_leads_to_is_shown() -> None:
    files = {NODE_FILE: None, "my_robot_controller/circle.py": NODE, **setup_py(f'            "{POINT}",\n', "")}
    found = of("entry-point", files, NOTHING)
    assert found.cause.startswith("my_robot_controller/circle.py exists, but setup.py has no entry point for it")


def leads_to(target: str) -> Build:
    return replace(BUILD, entry_points={"draw_circle": target})


@pytest.mark.parametrize(
    ("files", "build", "diagnosis", "where"),
    [
        (setup_py(f'            "{POINT}",\n', ""), NOTHING, "entry-point-missing", "setup.py:13"),
        (setup_py("console_scripts", "console_script"), NOTHING, "entry-point-group", "setup.py:13"),
        (
            setup_py(f'"{POINT}",', f'"test_node = my_robot_controller.first:main"\n            "{POINT}",'),
            replace(NOTHING, entry_points={"test_node": "x"}),
            "entry-point-comma",
            "setup.py:14",
        ),
        (
            setup_py("draw_circle = ", "draw_cirle = "),
            replace(
                NOTHING,
                entry_points={"draw_cirle": "my_robot_controller.draw_circle:main"},
                executables=("draw_cirle",),
            ),
            "entry-point-name",
            "setup.py:14",
        ),
        ({"setup.cfg": None}, replace(BUILD, executables=()), "setup-cfg", "setup.py"),
        ({}, leads_to("my_robot_controller.drawcircle:main"), "entry-point-module", "setup.py:14"),
        ({}, leads_to("draw_circle:main"), "entry-point-module", "setup.py:14"),
        ({}, leads_to("my_robot_controller.draw_circle:man"), "entry-point-function", "setup.py:14"),
        ({NODE_FILE: NODE + "\nmain = 7\n"}, BUILD, "entry-point-not-callable", f"{NODE_FILE}:23"),
        ({NODE_FILE: NODE.replace("def send(self):", "def send(self)")}, BUILD, "colon-missing", f"{NODE_FILE}:12"),
        ({NODE_FILE: b"name = '\xe4'\n"}, BUILD, "not-utf8", NODE_FILE),
        ({NODE_FILE: NODE.encode() + b"\0"}, BUILD, "syntax-error", NODE_FILE),
        ({NODE_FILE: NODE.encode("utf-16")}, BUILD, "not-utf8", NODE_FILE),
        (
            {"my_robot_controller/more/node.py": NODE},
            leads_to("my_robot_controller.more.node:main"),
            "missing-init",
            "setup.py:14",
        ),
        (
            {"my_robot_controller/more/node.py": NODE, "my_robot_controller/more/__init__.py": ""},
            leads_to("my_robot_controller.more.node:main"),
            "module-not-installed",
            "setup.py:14",
        ),
    ],
)
def test_each_fault_of_the_entry_point(files: Files, build: Build, diagnosis: str, where: str) -> None:
    found = of("entry-point", files, build)
    assert (found.status, found.diagnosis) == (Status.FAILED, diagnosis), found.observed
    assert str(found.where).startswith(where)


@pytest.mark.parametrize("file", ["draw_circle.py", "my_robot_controller/more/node.py"])
def test_a_module_next_to_setup_py_is_not_said_to_be_in_a_folder(file: str) -> None:
    files: Files = {file: NODE, "my_robot_controller/more/__init__.py": ""}
    found = of("entry-point", files, leads_to(f"{file.removesuffix('.py').replace('/', '.')}:main"))
    beside = found.cause == "draw_circle.py is next to setup.py. The file belongs in the folder my_robot_controller."
    assert (found.diagnosis, beside) == ("module-not-installed", "/" not in file)
    assert ("does not list the module's folder" in found.cause) == ("/" in file)


def test_a_setup_cfg_that_is_there_is_a_place_to_look() -> None:
    nowhere = replace(BUILD, executables=())
    assert of("entry-point", {"setup.cfg": None}, nowhere).cause == "setup.cfg is missing."
    assert str(of("entry-point", {}, nowhere).where) == "setup.cfg"


@pytest.mark.parametrize(
    "text",
    [
        "from my_robot_controller.other import main\n",
        "from my_robot_controller.other import *\n",
        "try:\n    import rclpy\nexcept ImportError:\n    def main():\n        pass\n",
        "class main:\n    pass\n",
        "main = lambda: None\n",
        "main = 7\ndef main():\n    pass\n",
        "if True:\n    def main():\n        pass\n",
        "import other as main\n",
    ],
)
def test_an_entry_point_may_name_anything_callable(text: str) -> None:
    assert of("entry-point", {NODE_FILE: text}).status is Status.PASSED


def test_a_function_inside_of_the_class_is_not_found() -> None:
    found = of("entry-point", {NODE_FILE: "class A:\n    def main(self):\n        pass\n"})
    assert found.cause == "main is indented, so it belongs to the class above it. Remove the indentation."
    assert found.observed == f"The entry point draw_circle names main, which is not at the top level of {NODE_FILE}."


@pytest.mark.parametrize("text", [b"x = " + b"(" * 5000, b"x = " + b"-" * 90_000 + b"1", b"a" * 500_000])
def test_a_file_that_is_too_much_to_parse_is_left_to_the_trial(text: bytes) -> None:
    assert of("entry-point", {NODE_FILE: text}).status in (Status.PASSED, Status.FAILED)


FOLDER = leads_to("my_robot_controller:main")


@pytest.mark.parametrize(
    ("files", "cause"),
    [
        ({}, "it is in my_robot_controller/draw_circle.py. Write my_robot_controller.draw_circle."),
        ({INIT: '"""Nodes."""\n'}, "Write my_robot_controller.draw_circle."),
        ({INIT: "def start():\n    pass\n"}, "Write my_robot_controller.draw_circle."),
        ({"my_robot_controller/first.py": NODE}, "Write my_robot_controller.draw_circle."),
        ({"my_robot_controller/long.py": "a" * 500_000}, "Write my_robot_controller.draw_circle."),
        ({NODE_FILE: None, "my_robot_controller/first.py": NODE}, "Write my_robot_controller.first."),
        (
            {NODE_FILE: None, "my_robot_controller/first.py": NODE, "my_robot_controller/second.py": NODE},
            "it is in my_robot_controller/first.py and my_robot_controller/second.py.",
        ),
        ({NODE_FILE: "x = 1\n"}, "looks for main in __init__.py. To name another file, write FOLDER.FILE."),
    ],
)
def test_an_entry_point_that_names_only_the_folder_is_told_the_file_with_the_function(files: Files, cause: str) -> None:
    found = of("entry-point", {INIT: "", **setup_py(POINT, POINT.replace(".draw_circle", "")), **files}, FOLDER)
    assert found.observed == "The entry point draw_circle names the folder my_robot_controller, but no file in it."
    assert (found.diagnosis, str(found.where)) == ("entry-point-function", "setup.py:14")
    assert found.cause.endswith(cause)
    assert bool(found.fix) == ("Write" in cause)


@pytest.mark.parametrize(
    ("files", "diagnosis"),
    [
        ({INIT: NODE}, None),
        ({INIT: "from .draw_circle import main\n"}, None),
        ({INIT: "", NODE_FILE: None}, "empty-file"),
        ({INIT: "class A:\n    def main(self):\n        pass\n"}, "main-in-class"),
        ({INIT: "def start():\n    pass\n", NODE_FILE: "x = 1\n"}, "entry-point-function"),
    ],
)
def test_an_entry_point_that_names_the_folder_leads_to_init_py(files: Files, diagnosis: str | None) -> None:
    found = of("entry-point", files, FOLDER)
    assert found.diagnosis == diagnosis
    assert "names the folder" not in found.observed


EMPTY: Files = {NODE_FILE: "\n"}
ONE_LINE: Files = {NODE_FILE: "x = 1\n"}
ELSEWHERE = replace(BUILD, executables=())


@pytest.mark.parametrize(
    ("words", "true", "near"),
    [
        ("my_robot_controller/draw_circle.py contains no code.", (EMPTY, BUILD), (ONE_LINE, BUILD)),
        ("Did you save the file?", (EMPTY, BUILD), (ONE_LINE, BUILD)),
        ("The function is at the top level of the file.", (ONE_LINE, BUILD), (EMPTY, BUILD)),
        ("The file contains the function main, which the entry point names.", (EMPTY, BUILD), (ONE_LINE, BUILD)),
        (
            "setup.cfg sets the folder for executables, so that `ros2 run` finds them.",
            ({}, ELSEWHERE),
            ({}, BUILD),
        ),
        ("setup.cfg is missing.", ({"setup.cfg": None}, ELSEWHERE), ({}, ELSEWHERE)),
    ],
)
def test_a_sentence_about_the_entry_point_is_true(
    words: str, true: tuple[Files, Build], near: tuple[Files, Build]
) -> None:
    assert words in told(of("entry-point", *true))
    assert words not in told(of("entry-point", *near))
