"""Each recorded command of the real `ros2` is typed again and must have the same output, errors and exit code.

Each test lists the differences that are allowed, and the reason for each.
"""

from __future__ import annotations

import re
import time
from typing import TYPE_CHECKING

import pytest

from grader.tests.both_worlds import REAL_ROS2
from grader.tests.domains import default_domain
from grader.tests.ros2.world import World, all_golden, build, environment, golden, world
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

NOTHING_RUNNING = ["topic_list_nothing_running"]
FILES_ONLY = [
    "interface_show_color",
    "interface_show_nope",
    "interface_show_pose",
    "interface_show_rotate_absolute",
    "interface_show_srv_Spawn",
    "interface_show_twist_no_comments",
    "pkg_executables_nope",
    "pkg_executables_turtlesim",
    "pkg_prefix_nope",
]
TURTLESIM_ONLY = [
    "node_list_turtlesim_only",
    "topic_echo_pose_csv",
    "topic_echo_pose_once",
    "topic_info_cmd_vel_before",
    "topic_list_turtlesim_only",
]
BOTH_RUNNING = [
    "action_info",
    "action_list",
    "action_list_t",
    "node_info_draw_circle",
    "node_info_nope",
    "node_info_turtlesim",
    "node_list",
    "param_describe_turtlesim",
    "param_get_background_r",
    "param_get_nope",
    "param_list",
    "service_call_badtype",
    "service_list",
    "service_list_t",
    "service_type_spawn",
    "topic_echo_unknown_topic",
    "topic_find_twist",
    "topic_find_unknown",
    "topic_info_cmd_vel",
    "topic_info_nope",
    "topic_list",
    "topic_list_c",
    "topic_list_t",
    "topic_type_cmd_vel",
    "topic_type_unknown",
]
OF_THEIR_OWN = {
    "action_send_goal",
    "interface_package_turtlesim",
    "interface_packages",
    "node-draw_circle",
    "node-turtlesim_node",
    "param_set_background_r",
    "param_set_out_of_range",
    "pkg_create_again",
    "pkg_create_ament_python",
    "pkg_create_tree_and_files",
    "service_call_spawn",
    "service_call_spawn_again",
    "topic_echo_cmd_vel",
    "topic_echo_pose_once_moving",
    "topic_hz_cmd_vel",
    "topic_hz_pose",
    "topic_info_cmd_vel_verbose",
    "topic_info_no_slash",
    "topic_list_v",
    "topic_pub_once",
}


@pytest.fixture(scope="module")
def empty(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    """Create a domain without nodes."""
    yield from world(tmp_path_factory.mktemp("empty"))


@pytest.fixture(scope="module")
def still(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    """Create a world with turtlesim, but without a node that drives."""
    for made in world(tmp_path_factory.mktemp("still")):
        made.turtlesim()
        yield made


@pytest.fixture(scope="module")
def install(tmp_path_factory: pytest.TempPathFactory) -> Path:
    home = tmp_path_factory.mktemp("workspace")
    return build(home, environment(home, default_domain()))


@pytest.fixture(scope="module")
def driving(tmp_path_factory: pytest.TempPathFactory, install: Path) -> Iterator[World]:
    """Create a world with turtlesim and draw_circle at 2 Hz."""
    for made in world(tmp_path_factory.mktemp("driving")):
        made.turtlesim()
        made.draw_circle(install)
        yield made


@pytest.fixture
def touched(tmp_path: Path) -> Iterator[World]:
    """Create a world with turtlesim for one test that changes it."""
    for made in world(tmp_path):
        made.turtlesim()
        yield made


def heard_at_once(text: str) -> str:
    """Remove the message that the real command prints if it does not discover a service immediately."""
    return text.replace("waiting for service to become available...\n", "") if REAL_ROS2 else text


def same(name: str, where: World, differs: Callable[[str], str] = lambda text: text) -> None:
    """Type the recorded command. `differs` removes allowed differences."""
    expected = golden(name)
    done = where.run(expected.command)
    assert differs(done.stdout) == differs(expected.stdout)
    assert done.stderr == expected.stderr
    assert done.code == expected.code


def test_every_recording_has_a_test() -> None:
    tested = {*NOTHING_RUNNING, *FILES_ONLY, *TURTLESIM_ONLY, *BOTH_RUNNING, *OF_THEIR_OWN}
    assert all_golden() == tested


@pytest.mark.parametrize("name", NOTHING_RUNNING + FILES_ONLY)
def test_with_nobody_running(name: str, empty: World) -> None:
    same(name, empty)


@pytest.mark.parametrize("name", TURTLESIM_ONLY)
def test_with_turtlesim(name: str, still: World) -> None:
    same(name, still)


@pytest.mark.parametrize("name", BOTH_RUNNING)
def test_with_turtlesim_and_draw_circle(name: str, driving: World) -> None:
    same(name, driving)


# --- allowed differences ----------------------------------------------------------------------------------------------


def test_interfaces_of_a_package_come_in_another_order(empty: World) -> None:
    # The real command prints the order of the directory. Our command sorts.
    same("interface_package_turtlesim", empty, lambda text: "\n".join(sorted(text.splitlines())))


def test_packages_with_interfaces_are_those_that_have_wheels(empty: World) -> None:
    expected = golden("interface_packages")
    not_as_wheels = {"composition_interfaces", "example_interfaces", "statistics_msgs"}
    done = empty.run(expected.command)
    found = done.stdout.splitlines()
    assert found == sorted(found)
    assert set(expected.stdout.splitlines()) - set(found) <= not_as_wheels
    assert (done.stderr, done.code) == ("", 0)


def test_endpoints_have_other_numbers(driving: World) -> None:
    # Each endpoint has a random GID.
    same(
        "topic_info_cmd_vel_verbose",
        driving,
        lambda text: re.sub(r"(?m)GID: [\da-f.]{47}$", "GID:", text),
    )


def test_verbose_list(driving: World) -> None:
    same("topic_list_v", driving)


def test_a_name_without_its_slash_gets_a_hint_as_well(driving: World) -> None:
    # The recording does not contain standard error. Our command adds the nearest name.
    expected = golden("topic_info_no_slash")
    done = driving.run(expected.command)
    assert (done.stdout, done.code) == (expected.stdout, expected.code)
    hint = "" if REAL_ROS2 else "Did you mean '/turtle1/cmd_vel'?\n"
    assert done.stderr == f"Unknown topic 'turtle1/cmd_vel'\n{hint}"


def test_echo_of_a_moving_turtle(driving: World) -> None:
    # The position of the turtle depends on the time, but its velocity does not. The turtle stands still until the first
    # command has arrived, and if draw_circle had to wait for a processor for more than a second.
    expected = golden("topic_echo_pose_once_moving")
    done = driving.run(expected.command)
    begun = time.monotonic()
    while "linear_velocity: 0.0" in done.stdout and time.monotonic() < begun + HANG_S:
        done = driving.run(expected.command)
    number = re.compile(r"^(x|y|theta): -?\d+\.\d+(e-\d+)?$", re.MULTILINE)
    assert number.sub(r"\1:", done.stdout) == number.sub(r"\1:", expected.stdout)
    assert (done.stderr, done.code) == ("", 0)


def test_echo_until_ctrl_c(driving: World) -> None:
    # The number of messages before Ctrl-C varies.
    expected = golden("topic_echo_cmd_vel")
    message = expected.stdout[: expected.stdout.index("---\n") + 4]
    assert expected.stdout == message * 4
    running = driving.start(expected.command)
    running.wait_for("---", times=3)
    assert running.stop() == expected.code
    text = "".join(f"{line}\n" for line in running.lines)
    assert text == message * text.count("---")


@pytest.mark.parametrize("name", ["topic_hz_cmd_vel", "topic_hz_pose"])
def test_hz_until_ctrl_c(name: str, driving: World) -> None:
    # Measured values vary.
    expected = golden(name)
    running = driving.start(expected.command)
    running.wait_for("window:", times=2)
    assert running.stop() == expected.code
    number = re.compile(r"\d+(\.\d+)?")

    def shape(text: str) -> list[str]:
        return [re.sub(r"\d", "0", line) if "min" in line else number.sub("N", line) for line in text.splitlines()]

    windows = re.compile(r"window: 0+")
    shown = [windows.sub("window: N", line) for line in shape("\n".join(running.lines))]
    requested = [windows.sub("window: N", line) for line in shape(expected.stdout)]
    assert shown[:4] == requested[:4]


def test_spawn_twice(touched: World) -> None:
    same("service_call_spawn", touched, heard_at_once)
    same("service_call_spawn_again", touched, heard_at_once)


def test_publish_once(touched: World) -> None:
    same("topic_pub_once", touched)


def test_set_a_parameter_within_its_range_and_beyond(touched: World) -> None:
    same("param_set_background_r", touched)
    same("param_set_out_of_range", touched)
    assert touched.run("ros2 param get /turtlesim background_r").stdout == "Integer value is: 150\n"


def test_send_a_goal(touched: World) -> None:
    # The goal has a random id.
    same("action_send_goal", touched, lambda text: re.sub(r"ID: [\da-f]{32}\n", "ID:\n", text))
