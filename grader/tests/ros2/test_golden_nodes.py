"""Nodes log the same lines and end with the same output as in the recordings of the real ROS 2."""

from __future__ import annotations

import re
from pathlib import Path

from grader.tests.ros2.world import build, world

LINE = re.compile(r"\[(\w+)\] \[\d+\.\d+\] (\[\w+\]: .*)")


def said(lines: list[str]) -> list[str]:
    """Return level, node and text of each log line, without the time stamps."""
    return [f"{match[1]} {match[2]}" for line in lines if (match := LINE.fullmatch(line))]


def test_turtlesim_logs_the_same_lines_as_the_real_one(tmp_path: Path) -> None:
    expected = said((Path(__file__).parents[1] / "golden/ros2/node-turtlesim_node.stderr.txt").read_text().splitlines())
    # The real program also prints a line of rclcpp's signal handler. Our program does not use rclcpp.
    assert expected.pop() == "INFO [rclcpp]: signal_handler(signum=2)"
    for where in world(tmp_path):
        turtlesim = where.turtlesim()
        spawn = "ros2 service call /spawn turtlesim/srv/Spawn"
        goal = "ros2 action send_goal /turtle1/rotate_absolute turtlesim/action/RotateAbsolute"
        for command in (
            f"{spawn} '{{x: 2, y: 2, theta: 0.2, name: t2}}'",
            f"{spawn} '{{x: 2, y: 2, theta: 0.2, name: t2}}'",
            f"{spawn} '{{x: 3, y: 3}}'",
            "ros2 service call /kill turtlesim/srv/Kill '{name: nope}'",
            "ros2 service call /clear std_srvs/srv/Empty",
            "ros2 service call /reset std_srvs/srv/Empty",
            f"{goal} '{{theta: 0.1}}'",
            f"{goal} '{{theta: 0.2}}'",
        ):
            assert where.run(command).code == 0, command
        assert turtlesim.stop() == 0
        assert said(turtlesim.lines) == expected


def test_ctrl_c_in_a_node_that_does_not_expect_it(tmp_path: Path) -> None:
    # The frames of the traceback are in rclpy and in the installed script, whose paths differ here.
    real = (Path(__file__).parents[1] / "golden/ros2/node-draw_circle.stderr.txt").read_text().splitlines()
    for where in world(tmp_path):
        install = build(tmp_path, where.env)
        module = next((install / "my_robot_controller").rglob("my_robot_controller/draw_circle.py"))
        as_many_write_it = module.read_text().replace("except (KeyboardInterrupt, ", "except (ZeroDivisionError, ")
        module.write_text(as_many_write_it)
        node = where.draw_circle(install)
        # The program prints its first line before it spins, so wait until it publishes.
        assert where.run("ros2 topic echo --once /turtle1/cmd_vel").code == 0
        assert node.stop() != 0
        started = [line for line in said(node.lines) if "started" in line]
        assert started == said(real)
        assert "Traceback (most recent call last):" in node.lines
        assert any(line.strip() == "rclpy.spin(node)" for line in node.lines)
        assert node.lines[-2] == real[-1] == "KeyboardInterrupt"
        # The recording contains only standard error.
        assert node.lines[-1] == "[ros2run]: Interrupt"
