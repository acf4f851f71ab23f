"""The node turtlesim on the real rclpy, compared with recordings of the real turtlesim."""

from __future__ import annotations

import re
import signal
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from PIL import Image

from grader.tests.waiting import LONG_S
from grader.turtlesim.services import SERVICES
from grader.turtlesim.turtle import SIDE_M

if TYPE_CHECKING:
    from grader.tests.in_ros import InRos

GOLDEN = Path(__file__).parents[1] / "golden" / "ros2"
INTERFACES = Path(__file__).parents[2] / "turtlesim/package"


def golden(name: str) -> list[str]:
    """Return the recorded output lines, without the command and its exit code."""
    lines = (GOLDEN / name).read_text().splitlines()
    return [line for line in lines if not line.startswith(("$ ", "[exit "))]


def log_of(stderr: str) -> list[str]:
    """Return the level and the text of each line that the node logged, without the time."""
    return re.findall(r"^(\[[A-Z]+\]) \[[0-9.]+\] (\[turtlesim\]: .*)$", stderr, re.MULTILINE)


# --- graph ----------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def graph(in_ros: InRos) -> dict[str, Any]:
    found: dict[str, Any] = in_ros.run("turtlesim.scenarios:graph").result
    return found


@pytest.mark.parametrize("section", ["Subscribers", "Publishers", "Service Servers", "Action Servers"])
def test_the_node_has_what_the_real_one_has(graph: dict[str, list[str]], section: str) -> None:
    recorded: dict[str, list[str]] = {}
    for line in golden("node_info_turtlesim.txt")[1:]:
        if line.endswith(":") and not line.startswith("    "):
            entries = recorded.setdefault(line.strip(" :"), [])
        elif line.strip():
            entries.append(line.strip())
    assert graph[section] == sorted(recorded[section])


def test_the_services_of_the_node_are_known_without_rclpy(graph: dict[str, list[str]]) -> None:
    assert sorted(SERVICES) == [entry.partition(":")[0] for entry in graph["Service Servers"]]


def test_topics_are_reliable_and_volatile_and_keep_seven(graph: dict[str, Any]) -> None:
    assert graph["QoS"] == [["RELIABLE", "VOLATILE"]] * 3
    assert graph["depth"] == 7


def test_a_driven_node_has_no_timer(graph: dict[str, Any]) -> None:
    assert graph["timers"] == 0


@pytest.mark.parametrize(
    ("shown", "source"),
    [
        ("interface_show_pose.txt", "msg/Pose.msg"),
        ("interface_show_color.txt", "msg/Color.msg"),
        ("interface_show_srv_Spawn.txt", "srv/Spawn.srv"),
        ("interface_show_rotate_absolute.txt", "action/RotateAbsolute.action"),
    ],
)
def test_interfaces_read_as_the_real_ones(shown: str, source: str) -> None:
    assert (INTERFACES / source).read_text().splitlines() == golden(shown)


# --- parameters -----------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def parameters(in_ros: InRos) -> dict[str, Any]:
    found: dict[str, Any] = in_ros.run("turtlesim.scenarios:parameters").result
    return found


def test_parameters_are_those_of_the_real_one(parameters: dict[str, Any]) -> None:
    lines = golden("param_list.txt")
    assert parameters["names"] == [line.strip() for line in lines[lines.index("/turtlesim:") + 1 :]]


def test_parameters_are_described_as_by_the_real_one(parameters: dict[str, Any]) -> None:
    types = {"boolean": 1, "integer": 2, "string": 4}
    text = "\n".join(golden("param_describe_turtlesim.txt"))
    for block in text.split("Parameter name: ")[1:]:
        name, *lines = block.splitlines()
        reported = dict(line.strip().split(": ", 1) for line in lines if ": " in line)
        limits = (
            [[int(reported["Min value"]), int(reported["Max value"]), int(reported["Step"])]]
            if "Min value" in reported
            else []
        )
        assert parameters["described"][name] == [
            types[reported["Type"]],
            reported.get("Description", ""),
            limits,
            reported.get("Read only") == "true",
        ]


def test_a_colour_out_of_range_is_refused_in_the_same_words(parameters: dict[str, Any]) -> None:
    said = golden("param_set_out_of_range.stderr.txt")[0].removeprefix("Setting parameter failed: ")
    assert parameters["refused"] == [False, said]


def test_other_refusals_have_the_words_of_rclcpp(parameters: dict[str, Any]) -> None:
    depth = "qos_overrides./parameter_events.publisher.depth"
    assert parameters["undeclared"] == [False, "parameter 'nope' cannot be set because it was not declared"]
    assert parameters["read-only"] == [False, f"parameter '{depth}' cannot be set because it is read-only"]
    assert parameters["deleted"] == [False, "cannot undeclare a statically typed parameter"]
    assert parameters["wrong type"] == [
        False,
        "Wrong parameter type, parameter {background_r} is of type {integer}, setting it to {string} is not allowed.",
    ]
    assert parameters["kept"] == [69, 86, 255]


def test_parameters_take_effect(parameters: dict[str, Any]) -> None:
    assert parameters["accepted"] == [True, ""]
    assert parameters["background"] == [150, 86, 255]
    assert parameters["holonomic"]


# --- services and the action ----------------------------------------------------------------------------------------


def test_log_and_answers_are_those_of_the_real_one(in_ros: InRos) -> None:
    ran = in_ros.run("turtlesim.scenarios:as_recorded")
    assert ran.result == {"spawn": "t2", "again": "", "unnamed": "turtle2"}
    assert log_of(ran.stderr) == log_of((GOLDEN / "node-turtlesim_node.stderr.txt").read_text())


def test_services(in_ros: InRos) -> None:
    found = in_ros.run("turtlesim.scenarios:services").result
    assert found["start"] == pytest.approx([4.0, 5.0, 0.25])
    assert found["absolute"] == pytest.approx([1.0, 2.0, 0.5])
    assert found["relative"] == pytest.approx([2.0, 2.0, 0.0])
    assert found["pen"] == [[1, 2, 3], 1, True]
    assert found["pen up"] == [[1, 2, 3], 1, False]
    assert found["outside"] == pytest.approx([SIDE_M, 0.0, 7.0 - 6.283185307])
    assert found["seen"] == [69, 86, 255]
    assert found["left by far"] == []
    assert found["reset"] == pytest.approx([4.0, 5.0, 0.25])


def test_rotate_absolute(in_ros: InRos) -> None:
    found = in_ros.run("turtlesim.scenarios:rotations").result
    assert found["status"] == "succeeded"
    assert found["delta"] == pytest.approx(-0.5, abs=0.021)
    assert found["feedback"]
    assert found["cancel"] == "canceled"
    assert (found["second goal"], found["command"], found["reset"]) == ("aborted", "aborted", "aborted")
    assert found["after kill"] == "turtle1"


def test_a_trial_knows_what_became_of_each_goal(in_ros: InRos) -> None:
    goals = in_ros.run("turtlesim.scenarios:rotations").result["log"]
    assert [goal["request"]["theta"] for goal in goals] == pytest.approx([0.5, 3.0, -3.0, -2.9, 3.0, 3.0])
    assert [goal["status"] for goal in goals] == ["succeeded", "canceled", *["aborted"] * 4]
    assert {(goal["action"], goal["type"]) for goal in goals} == {
        ("/turtle1/rotate_absolute", "turtlesim/action/RotateAbsolute")
    }
    first, second, *_, last = goals
    assert first["t_s"] < first["ended_s"] <= second["t_s"] <= second["cancel_asked_s"] <= second["ended_s"]
    assert first["t_s"] <= first["result_asked_s"] <= first["ended_s"]
    assert first["result"]["delta"] == pytest.approx(-0.5, abs=0.021)
    assert [goal["cancel_asked_s"] is None for goal in goals] == [True, False, *[True] * 4]
    assert last["result_asked_s"] is None


def test_wrong_requests_do_not_stop_the_node(in_ros: InRos) -> None:
    found = in_ros.run("turtlesim.scenarios:hostile").result
    assert found["names"] == [""] * 8
    assert found["turtles"] == ["turtle1"]
    assert found["no number"] == "nan"
    assert found["recovers"]
    assert found["most"] == 64
    assert found["after"] == ["turtle1"]


def test_a_trial_knows_what_the_node_subscribes_to_and_publishes(in_ros: InRos) -> None:
    found = in_ros.run("turtlesim.scenarios:hooks").result
    assert found["topic"] == "/turtle1/cmd_vel"
    assert found["as sent"]
    assert found["published"] == [
        ["/turtle1/pose", "turtlesim/msg/Pose"],
        ["/turtle1/color_sensor", "turtlesim/msg/Color"],
    ]
    assert found["pose as state"]
    assert found["interventions"] == [
        "clear",
        "spawn",
        "set_pen",
        "teleport_absolute",
        "teleport_relative",
        "kill",
        "rotate_absolute",
        "set_background",
        "set_parameters",
        "reset",
    ]


# --- without a client -----------------------------------------------------------------------------------------------


def test_pose_and_colour_may_be_published_less_often(in_ros: InRos) -> None:
    assert in_ros.run("turtlesim.scenarios:every_fourth_frame").result == ["/turtle1/pose", "/turtle1/color_sensor"] * 2


def test_only_the_first_pose_of_turtle1_is_late(in_ros: InRos) -> None:
    assert in_ros.run("turtlesim.scenarios:first_poses").result == {"/turtle1/pose": 0.8, "/berta/pose": 0.0}


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_the_executable_runs_until_ctrl_c_and_leaves_a_picture(
    in_ros: InRos, tmp_path: Path, number: signal.Signals
) -> None:
    if in_ros.ros.underlay is None:
        pytest.skip("this ROS 2 has a turtlesim of its own")
    image = tmp_path / "canvas.png"
    node = in_ros.ros.underlay / "lib/turtlesim/turtlesim_node"
    command = [str(node), "--image", str(image), "--ros-args", "-r", "__node:=pond", "-p", "background_r:=0"]
    with subprocess.Popen(command, env=in_ros.environment(), stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        lines = [process.stderr.readline(), process.stderr.readline()]
        process.send_signal(number)
        rest = process.stderr.read()
    assert process.returncode == 0
    assert lines[0].endswith("[pond]: Starting turtlesim with node name /pond\n")
    assert "Spawning turtle [turtle1]" in lines[1]
    assert rest == ""
    with Image.open(image) as picture:
        assert picture.size == (500, 500)
        assert picture.getpixel((10, 10)) == (0, 86, 255)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--nope"], "unrecognized arguments: --nope"),
        (["--ros-args", "-p", "background_r:=999"], "out of range"),
        (["--ros-args", "-p", "background_r:=red"], "expecting type 'INTEGER'"),
        (["--ros-args", "-p"], "Couldn't parse"),
    ],
)
def test_wrong_arguments_end_with_2_and_one_message(in_ros: InRos, arguments: list[str], said: str) -> None:
    done = subprocess.run(
        [in_ros.ros.python, "-m", "grader.view.turtlesim_node", *arguments],
        env=in_ros.environment(),
        capture_output=True,
        text=True,
        timeout=LONG_S,
        check=False,
    )
    assert done.returncode == 2
    assert said in done.stderr
    assert "Traceback" not in done.stderr
