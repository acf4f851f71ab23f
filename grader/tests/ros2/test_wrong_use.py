"""Wrong commands print the reason, the nearest name and an exit code, but never a traceback."""

# ruff: noqa: RUF001 - some commands have typographic dashes

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING

import pytest

from grader.ros2.service import call
from grader.tests.ros2.world import World, world

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


@pytest.fixture(scope="module")
def still(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    """Create a world with turtlesim, but without a node that drives."""
    for made in world(tmp_path_factory.mktemp("still")):
        made.turtlesim()
        yield made


SPAWN = "ros2 service call /spawn turtlesim/srv/Spawn"
PUB = "ros2 topic pub --once /turtle1/cmd_vel geometry_msgs/msg/Twist"
FILES_ONLY = {
    # command -> exit code, parts of standard error
    "ros2 lst": (2, ["invalid choice: 'lst'"]),
    "ros2 topci list": (2, ["invalid choice: 'topci'", "Did you mean 'topic'?"]),
    "ros2 topic lst": (2, ["invalid choice: 'lst'", "Did you mean 'list'?"]),
    "ros2 topic info": (2, ["the following arguments are required: topic_name"]),
    "ros2 run turtlesm turtlesim_node": (1, ["Package 'turtlesm' not found", "Did you mean 'turtlesim'?"]),
    "ros2 run turtlesim turtlesim": (1, ["No executable found", "Did you mean 'turtlesim_node'?"]),
    "ros2 run rclpy node": (1, ["No executable found", "Executables of rclpy: none"]),
    "ros2 run --prefix nope turtlesim turtlesim_node": (1, ["the command 'nope' was not found"]),
    'ros2 run --prefix "\'" turtlesim turtlesim_node': (1, ["The prefix cannot be read"]),
    "ros2 pkg prefix turtlesm": (1, ["Package not found", "Did you mean 'turtlesim'?"]),
    "ros2 pkg executables turtlesm": (1, ["Package 'turtlesm' not found", "Did you mean 'turtlesim'?"]),
    "ros2 pkg create --build-type ament_python test": (
        1,
        ["Aborted since 'ament_python' packages can't be named 'test'."],
    ),
    "ros2 pkg create --build-type ament_python a/b": (1, ["Aborted!", "name 'a/b' cannot be the name of a file"]),
    "ros2 pkg create --build-type ament_python a --destination-directory /proc/no": (1, ["could not be written"]),
    "ros2 pkg create --build-type python my_robot": (2, ["invalid choice: 'python'"]),
    "ros2 interface show geometry_msgs/msg/Twst": (1, ["Could not find", "Did you mean 'geometry_msgs/msg/Twist'?"]),
    "ros2 interface show geometry_msg/msg/Twist": (1, ["Unknown package", "Did you mean 'geometry_msgs'?"]),
    "ros2 interface show geometry_msgs//Twist": (1, ["Must not contain empty parts"]),
    "ros2 interface show geometry_msgs/Twist": (
        1,
        ["Expected three parts separated by '/'", "Did you mean 'geometry_msgs/msg/Twist'?"],
    ),
    "ros2 interface show Twist": (1, ["Expected three parts", "Did you mean 'geometry_msgs/msg/Twist'?"]),
    "ros2 interface show -": (2, ["the passed value is empty"]),
    "ros2 interface show --all-comments --no-comments a/msg/B": (2, ["not allowed with argument --all-comments"]),
    "ros2 interface proto geometry_msgs/msg/Twst": (1, ["Could not find", "Did you mean 'geometry_msgs/msg/Twist'?"]),
    "ros2 pkg xml turtlesm": (1, ["Package not found", "Did you mean 'turtlesim'?"]),
    "ros2 pkg xml turtlesim -t versin": (1, ["XML tag not found", "Did you mean 'version'?"]),
    "ros2 interface package turtlesm": (1, ["Unknown package 'turtlesm'", "Did you mean 'turtlesim'?"]),
    "ros2 topic pub /a geometry_msgs/msg/Twst": (
        1,
        ["message type is invalid", "Did you mean 'geometry_msgs/msg/Twist'?"],
    ),
    "ros2 topic pub /a Twist": (1, ["message type is invalid", "Did you mean 'geometry_msgs/msg/Twist'?"]),
    "ros2 topic pub /a geometry_msgs/srv/Twist": (1, ["message type is invalid"]),
    "ros2 topic pub /a ../msg/Twist": (1, ["message type is invalid"]),
    "ros2 topic pub -r 0 /a geometry_msgs/msg/Twist": (2, ["argument -r/--rate: Value must be positive"]),
    "ros2 topic pub -r nan /a geometry_msgs/msg/Twist": (2, ["argument -r/--rate: Value must be positive"]),
    "ros2 topic pub -r x /a geometry_msgs/msg/Twist": (2, ["argument -r/--rate: Expects a floating point number"]),
    "ros2 topic pub -t x /a geometry_msgs/msg/Twist": (2, ["argument -t/--times: invalid nonnegative_int value: 'x'"]),
    "ros2 topic pub --once -t 2 /a geometry_msgs/msg/Twist": (2, ["not allowed with argument -1/--once"]),
    "ros2 topic pub --max-wait-time-secs 1 /a std_msgs/msg/Bool": (1, ["option is only effective with"]),
    "ros2 topic hz -w x /a": (2, ["argument --window/-w: value must be a positive integer"]),
    "ros2 topic hz --filter 'm.' /a": (1, ["The filter is not a Python expression"]),
    "ros2 topic echo /a --qos-reliability often": (2, ["invalid choice: 'often'"]),
    "ros2 topic echo /a --truncate-length x": (2, ["value must be non-negative integer"]),
    "ros2 topic echo /a --field .": (1, ["Invalid field value '.'"]),
    "ros2 topic echo /a//b": (1, ["Invalid topic name"]),
    "ros2 topic list -a": (2, ["ros2: error: unrecognized arguments: -a"]),
    "ros2 topic list –t": (2, ["unrecognized arguments: –t", "–t begins with a typographic dash. Type: -t"]),
    "ros2 topic echo /a —once": (1, ["—once begins with a typographic dash. Type: --once"]),
    f"{PUB} “{{linear: {{x: 2.0}}}}”": (2, ["typographic. Type straight ones: '{linear: {x: 2.0}}'"]),
    f"{PUB} “{{}}”": (1, ["needs to be a dictionary in YAML format", "Type straight ones: '{}'"]),
    f"{PUB} {{linear: {{x: 2.0}}}}": (2, ["A value with spaces needs quotation marks. Type: '{linear: {x: 2.0}}'"]),
    f"{PUB} '{{linear: {{x: 2.0}}'": (1, ["not YAML", "expected ',' or '}'"]),
    f"{PUB} '{{linear: [}}'": (1, ["not YAML"]),
    f"{PUB} 'linear'": (1, ["needs to be a dictionary in YAML format"]),
    f"{PUB} 'x:2.0'": (1, ["needs to be a dictionary in YAML format", "needs a space after it"]),
    f"{PUB} '{{lineer: {{x: 2.0}}}}'": (1, ["object has no attribute 'lineer'", "Did you mean 'linear'?"]),
    f"{PUB} '{{linear: 2.0}}'": (
        1,
        ["Failed to populate field: Value '2.0' is expected to be a dictionary but is a float", '"{x: ...}"'],
    ),
    f"{PUB} '{{linear: {{x: fast}}}}'": (
        1,
        ["Failed to populate field: could not convert string to float: 'fast'", "The field 'x' has the type double."],
    ),
    f"{PUB} '{{linear: {{x: [1.0]}}}}'": (
        1,
        ["Failed to populate field: expected a single value", "'x' has the type double."],
    ),
    f"{SPAWN} '{{xx: 3}}'": (1, ["object has no attribute 'xx'"]),
    f"{SPAWN} '{{name: {{a: 1}}}}'": (
        1,
        ["expected a single value", "'name' has the type string"],
    ),
    f"{SPAWN} 3": (1, ["Failed to populate field: Value '3' is expected to be a dictionary but is a int"]),
    f"{SPAWN} -r 0": (1, ["rate must be greater than zero"]),
    "ros2 topic pub /a std_msgs/msg/UInt8 '{data: 256}'": (
        1,
        ["Failed to populate field: The 'data' field must be an unsigned integer in [0, 255]", "has the type uint8"],
    ),
    "ros2 topic pub /a std_msgs/msg/UInt8 '{data: 2.5}'": (1, ["expected a whole number"]),
    "ros2 topic pub /a std_msgs/msg/Bool '{data: 2}'": (1, ["expected true or false"]),
    "ros2 topic pub '/a b' std_msgs/msg/Bool": (1, ["Cannot publish on the topic '/a b'"]),
    "ros2 topic pub -n 'a b' /a std_msgs/msg/Bool": (1, ["The ROS 2 node could not be created"]),
}
WITH_TURTLESIM = {
    "ros2 topic info /turtle1/cmd_vl": (1, ["Unknown topic", "Did you mean '/turtle1/cmd_vel'?"]),
    "ros2 topic type /turtle1/pos": (1, ["Did you mean '/turtle1/pose'?"]),
    "ros2 topic find geometry_msgs/msg/Twst": (0, ["Did you mean 'geometry_msgs/msg/Twist'?"]),
    "ros2 topic echo --once /turtle1/pos": (1, ["Could not determine the type", "Did you mean '/turtle1/pose'?"]),
    "ros2 topic echo --once /turtle1/pose --field linear": (1, ["Invalid field 'linear'", "'linear_velocity'"]),
    "ros2 node info /turtlesm": (1, ["Unable to find node '/turtlesm'", "Did you mean '/turtlesim'?"]),
    "ros2 service type /spwn": (1, ["Did you mean '/spawn'?"]),
    "ros2 service find turtlesim/srv/Spwn": (0, ["Did you mean 'turtlesim/srv/Spawn'?"]),
    "ros2 service call /spawn turtlesim/srv/Spwn": (1, ["service type is invalid", "'turtlesim/srv/Spawn'"]),
    "ros2 param get /turtlesm background_r": (1, ["Node not found", "Did you mean '/turtlesim'?"]),
    "ros2 param get /turtlesim backgroun_r": (1, ["Parameter not set", "Did you mean 'background_"]),
    "ros2 param describe /turtlesim nope": (0, ["Parameter 'nope' is not declared by /turtlesim"]),
    "ros2 param set /turtlesim background_r red": (0, ["Setting parameter failed"]),
    "ros2 param set /turtlesim backgroun_r 1": (0, ["Setting parameter failed", "Did you mean 'background_"]),
    "ros2 param set /turtlesim background_r '[1, '": (0, ["Setting parameter failed"]),
    "ros2 param load /turtlesim nowhere.yaml": (1, ["nowhere.yaml cannot be read: No such file"]),
    "ros2 param load /turtlesim /dev/zero": (1, ["/dev/zero cannot be read: it is a device, not a file"]),
    "ros2 param load /turtlesim <(echo '/**: {ros__parameters: {a: 2027-01-01}}')": (1, ["is not a parameter file"]),
    f"ros2 param load /turtlesim <(echo '/**: {{ros__parameters: {{a: {10**20}}}}}')": (1, ["must be an integer in"]),
    "ros2 param list /turtlesm": (1, ["Node not found", "Did you mean '/turtlesim'?"]),
    "ros2 param list --filter '('": (1, ["is not a regular expression"]),
    "ros2 action info /turtle1/rotate": (0, ["Did you mean '/turtle1/rotate_absolute'?"]),
    "ros2 action type /turtle1/rotate": (1, ["Did you mean '/turtle1/rotate_absolute'?"]),
    "ros2 service info /spwn": (1, ["Unknown service '/spwn'", "Did you mean '/spawn'?"]),
    "ros2 service echo /spwn": (1, ["Cannot find type for '/spwn'", "Did you mean '/spawn'?"]),
    "ros2 topic echo /turtle1/pose --qos-liveliness-lease-duration-seconds 1e30": (1, ["too long: 1e+30 s"]),
    "ros2 service echo '/odd name' std_srvs/srv/Empty": (1, ["topic name '/odd name/_service_event' is invalid"]),
    "ros2 action send_goal '/odd name' turtlesim/action/RotateAbsolute": (1, ["action '/odd name' cannot be used: "]),
    "ros2 node info turtlesim": (1, ["Unable to find node 'turtlesim'", "Did you mean '/turtlesim'?"]),
    "ros2 topic delay /turtle1/pose": (1, ["msg does not have header"]),
    "ros2 topic echo --once /turtle1/pose --filter m.z": (1, ["The filter 'm.z' failed: AttributeError"]),
    "ros2 action send_goal /turtle1/rotate_absolute turtlesim/action/RotateAbsolute '{thet: 1}'": (
        1,
        ["Failed to populate message fields: AttributeError(", "Did you mean 'theta'?"],
    ),
    "ros2 action send_goal /turtle1/rotate_absolute turtlesim/action/Rotate {}": (1, ["action type is invalid"]),
}


def check(where: World, command: str, code: int, said: list[str]) -> None:
    done = where.run(command)
    assert done.code == code, done
    for text in said:
        assert text in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("command", FILES_ONLY)
def test_without_anybody_running(command: str, still: World) -> None:
    check(still, command, *FILES_ONLY[command])


@pytest.mark.parametrize("command", WITH_TURTLESIM)
def test_beside_turtlesim(command: str, still: World) -> None:
    check(still, command, *WITH_TURTLESIM[command])


@pytest.mark.parametrize("name", ["My-Robot", "1robot", "it's"])
def test_a_package_with_an_odd_name_is_made_and_warned_of(name: str, still: World, tmp_path: Path) -> None:
    create = f'ros2 pkg create --build-type ament_python --destination-directory {tmp_path} "{name}" --node-name a-b'
    done = still.run(create)
    assert done.code == 0
    assert "a-b' can cause problems" in done.stderr
    compile((tmp_path / name / "setup.py").read_text(), "setup.py", "exec")


@pytest.mark.parametrize(
    ("command", "hint"),
    [
        ("ros2 service call /spwn turtlesim/srv/Spawn", "Did you mean '/spawn'?"),
        ("ros2 service call /spawn turtlesim/srv/Kill", "The service /spawn has the type turtlesim/srv/Spawn."),
        (
            "ros2 action send_goal /turtle1/rotate turtlesim/action/RotateAbsolute '{theta: 1}'",
            "Did you mean '/turtle1/rotate_absolute'?",
        ),
        ("ros2 topic hz /turtle1/pos", "Did you mean '/turtle1/pose'?"),
        (
            "ros2 topic pub --once /turtle1/cmd_vl geometry_msgs/msg/Twist",
            "Did you mean '/turtle1/cmd_vel'?",
        ),
    ],
)
def test_a_waiting_command_prints_a_hint_and_ends_on_ctrl_c(command: str, hint: str, still: World) -> None:
    waiting = still.start(command, hint)
    assert waiting.stop() == 2
    assert "Traceback" not in "\n".join(waiting.lines)


def test_all_types_of_a_service_are_named(capsys: pytest.CaptureFixture[str]) -> None:
    node = SimpleNamespace(get_service_names_and_types=lambda: [("/a", ["b/srv/C", "b/srv/D", "b/srv/E"])])
    call._say_why(node, "/a", "b/srv/E")
    assert capsys.readouterr().err == "The service /a has the types b/srv/C and b/srv/D.\n"


def test_two_turtlesims_are_reported(tmp_path_factory: pytest.TempPathFactory) -> None:
    for where in world(tmp_path_factory.mktemp("two")):
        where.turtlesim()
        where.turtlesim()
        listed = where.run("ros2 node list")
        assert (listed.stdout, listed.code) == ("/turtlesim\n/turtlesim\n", 0)
        assert "share an exact name" in listed.stderr
        info = where.run("ros2 node info /turtlesim")
        assert 'There are 2 nodes in the graph with the exact name "/turtlesim"' in info.stderr
        assert where.run("ros2 topic info /turtle1/cmd_vel").stdout.endswith("Subscription count: 2\n")


def test_a_domain_that_does_not_exist(still: World) -> None:
    done = still.run("ros2 topic list", ROS_DOMAIN_ID="500")
    assert done.code == 1
    assert "Traceback" not in done.stderr
    assert done.stderr == (
        "ROS_DOMAIN_ID is '500'; a whole number from 0 to 232 was expected. "
        "To use the usual domain, type: unset ROS_DOMAIN_ID\n"
    )


def test_a_reader_that_exits_early_is_no_error(still: World) -> None:
    done = still.run("set -o pipefail; ros2 topic echo /turtle1/pose | head -n 1")
    assert done.stdout.startswith("x: ")
    assert done.stderr == ""


def test_the_reader_of_pkg_create_may_exit(still: World, tmp_path: Path) -> None:
    # The reader exits before the first line is printed.
    done = still.run(f"ros2 pkg create --build-type ament_python a --destination-directory {tmp_path} > >(exec true)")
    assert "Traceback" not in done.stderr
    assert "could not be written" not in done.stderr


def test_help_without_arguments(still: World) -> None:
    for command in ("ros2", "ros2 topic", "ros2 --help"):
        done = still.run(command)
        assert done.stdout.startswith("usage: ros2")
        assert (done.stderr, done.code) == ("", 0)
