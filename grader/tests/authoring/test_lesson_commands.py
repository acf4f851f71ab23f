"""The commands in a lesson are parsed, but not run."""

from __future__ import annotations

import pytest

from grader.authoring.lesson_commands import command_problems, simple_commands
from grader.cli import app
from grader.exercise.model import course_folder


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
