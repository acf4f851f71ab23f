"""The commands in a lesson are parsed, but not run."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.authoring.lesson_commands import command_problems, simple_commands
from grader.authoring.solution_programs import TURTLESIM, programs_of
from grader.cli import app
from grader.exercise.model import course_folder
from grader.ros.index import executables_in
from grader.ros.installation import find_ros
from grader.ros.underlay import with_turtlesim

if TYPE_CHECKING:
    from pathlib import Path


def problems(*lines: str, language: str = "console") -> list[str]:
    return list(command_problems("\n".join([f"```{language}", *lines, "```"]), course_folder(), app))


@pytest.mark.parametrize(
    ("line", "reported"),
    [
        ("grader chekc", "No such command 'chekc'. Did you mean 'check'?"),
        ("grader check --fast", "No such option: --fast."),
        ("grader lessons", "There is no command lessons. Type: grader open."),
        ("grader gradebook synk", "No such command 'synk'. Did you mean 'sync'?"),
        ("grader start 44", "the course has no step 44."),
        ("grader check ~/mine --exercise 44", "the course has no step 44."),
        ("grader check 77", "the course has no step 77."),
        ("grader gradebook sync 03 99", "the course has no step 99."),
        ("grader gradebook sync 98 03 99", "the course has no step 98 or 99."),
        ("ros2 topci list", "there is no topci. Did you mean 'topic'?"),
        ("ros2 topic lst", "there is no lst. Did you mean 'list'?"),
        ("ros2 topic echo /a --onec", "unrecognized arguments: --onec."),
        ("ros2 topic echo", "the following arguments are required: topic_name."),
        (
            "ros2 run turtlesim turtlesim",
            "the package turtlesim has no executable 'turtlesim'. Did you mean 'turtlesim_node'?",
        ),
        (
            "ros2 run turtlesm mimic",
            "the package 'turtlesm' is not my_robot_controller or turtlesim. Did you mean 'turtlesim'?",
        ),
        (
            "ros2 run --prefix nice my_robot_controller catchr",
            "the package my_robot_controller has no executable 'catchr'. Did you mean 'catcher'?",
        ),
        ("ros2 launch x y", "the course's ros2 does not support it."),
        ("colcon biuld", "there is no biuld. Did you mean 'build'?"),
        ("cd src && colcon build --symlnk", "unrecognized arguments: --symlnk."),
        ("ros2 topic list | head -3; grader statsu", "No such command 'statsu'. Did you mean 'status', 'start'?"),
        ("source <(grader evn)", "No such command 'evn'. Did you mean 'env'?"),
    ],
)
def test_a_wrong_command_is_reported_with_its_line(line: str, reported: str) -> None:
    assert problems(f"$ {line}") == [f"`{line}` is not a valid command: {reported}"]


def test_right_commands_are_not_reported() -> None:
    lines = [
        *("grader start 3", "grader start next", "grader hint 07 d", "grader run 07 draw_square", "grader", "ros2"),
        *("grader check --help", "ros2 topic --help", "ros2 bag info circle_bag", "colcon test-result --verbose"),
        *("grader check exercises/03-circle-publisher --exercise 03", "ROS_DOMAIN_ID=3 ros2 node list > nodes.txt &"),
        *("ros2 run my_robot_controller catcher --ros-args -p reach_m:=0.5", "ls --no-such-option"),
        'ros2 topic pub -r 10 /turtle1/cmd_vel geometry_msgs/msg/Twist "{linear: {x: 1.0}, angular: {z: 0.7}}"',
    ]
    assert problems(*(f"$ {line}" for line in lines), "grader chekc") == []  # the last line is output


def test_a_lesson_starts_only_what_its_own_solution_has() -> None:
    lesson = "```console\n$ ros2 run my_robot_controller catcher\n```\n```bash\nros2 run turtlesim mimic\n```\n"
    assert list(command_problems(lesson, course_folder(), app, "13-catch-them-all")) == []
    (problem,) = command_problems(lesson, course_folder(), app, "05-build-and-run")
    assert "the package my_robot_controller has no executable 'catcher'." in problem
    assert list(command_problems(lesson, course_folder(), app, "02-discover-topics")) == []  # it has no package


def test_without_solutions_executables_are_not_checked(tmp_path: Path) -> None:
    assert programs_of(tmp_path / "course", "05-build-and-run") == {}
    assert list(command_problems("```console\n$ ros2 run a b\n```\n", tmp_path / "course", app)) == []


def test_the_executables_of_turtlesim_are_those_of_the_course() -> None:
    built = course_folder().parent / "grader/turtlesim/package/CMakeLists.txt"
    assert all(name in built.read_text() for name in TURTLESIM)
    ros = with_turtlesim(find_ros(), lambda _: None)
    folders = [prefix / "lib/turtlesim" for prefix in ros.all_prefixes]
    assert {file.name for folder in folders if folder.is_dir() for file in executables_in(folder)} == TURTLESIM


def test_only_blocks_for_a_shell_contain_commands() -> None:
    assert problems("grader chekc", language="python") == []
    assert len(problems("grader chekc", language="bash")) == 1


def test_a_command_may_have_several_lines() -> None:
    assert problems("$ ros2 topic echo \\", "> /turtle1/pose --once", "x: 5.5") == []


def test_a_missing_quotation_mark_is_reported() -> None:
    assert problems('$ echo "a') == ['`echo "a` cannot be read by a shell: No closing quotation.']


def test_a_line_of_a_shell_has_several_commands() -> None:
    line = "until ros2 topic list 2> /dev/null | grep -E '^x: (1|2)[.]'; do :; done # wait"
    assert simple_commands(line)[1:] == [["grep", "-E", "^x: (1|2)[.]"], [":"], ["done"]]
