"""The lines that a step needs in package files that the learner already has."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.learner import steps

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.usefixtures("home")


def test_start_lists_lines_that_a_later_step_needs_in_package_files(home: Path) -> None:
    steps.start("01", None)
    package = home / "ros2_ws/src/my_robot_controller"
    setup = (package / "setup.py").read_text()
    entry = "'test_node = my_robot_controller.my_first_node:main'"
    (package / "setup.py").write_text(setup.replace('"console_scripts": [', f'"console_scripts": [{entry},\n{entry}'))
    begun = steps.start("03", None)
    assert begun.started.lacking == {
        "package.xml": ("<depend>geometry_msgs</depend>", "<depend>turtlesim</depend>"),
        "setup.py": ('"draw_circle = my_robot_controller.draw_circle:main",',),
    }
    assert (
        'Add this line to the list console_scripts, with a comma after each item:\n    "draw_circle'
        in steps.begin_message(begun)
    )
    assert "package.xml. Add these lines to your file, next to the other dependencies:" in steps.begin_message(begun)
    # The entry points of the steps in between are not needed.
    assert "setup.py" not in steps.start("08", None).started.lacking
    assert steps.start("03", None, fresh=True).started.lacking == {}


def test_start_asks_for_no_line_of_which_the_learner_has_an_own_version(home: Path) -> None:
    steps.start("12", None)
    package = home / "ros2_ws/src/my_robot_controller"
    setup = package / "setup.py"
    own = (
        setup.read_text().replace('maintainer="Student"', 'maintainer="Ada"').replace('version="0.1.0"', "version='2'")
    )
    own = own.replace("import find_packages, setup", "import setup").replace('find_packages(exclude=["test"])', "[]")
    setup.write_text(
        own.replace("zip_safe=", 'extras_require={\n    "test": ["pytest", "flake8"],\n    },\n    zip_safe=')
    )
    manifest = package / "package.xml"
    other = manifest.read_text().replace(">Student<", ">Ada<").replace("Nodes that", "What").replace("0.1.0", "2.0.0")
    manifest.write_text(other.replace("<depend>rclpy</depend>", '<exec_depend version_gte="7.0">rclpy</exec_depend>'))
    assert steps.start("13", None).started.lacking == {"package.xml": ("<test_depend>python3-pytest</test_depend>",)}
    manifest.write_text(manifest.read_text().replace("<exec_depend version", "<build_depend version"))
    assert "<depend>rclpy</depend>" in steps.start("13", None).started.lacking["package.xml"]


def test_start_lists_the_questions_that_answers_toml_does_not_have() -> None:
    steps.start("05", None)
    begun = steps.start("11", None)
    questions = begun.started.lacking["answers.toml"]
    assert [line for line in questions if not line.startswith("#")] == [
        "messages = 0",
        'duration = ""',
        'rate = ""',
        'radius = ""',
    ]
    assert questions[0].startswith("# How many messages")
    answers = begun.started.folder / "answers.toml"
    answers.write_text(f"{answers.read_text()}{chr(10).join(questions)}\n".replace("messages = 0", "messages=9"))
    assert "answers.toml" not in steps.start("11", None).started.lacking
    assert "answers.toml" not in steps.start("05", None).started.lacking
