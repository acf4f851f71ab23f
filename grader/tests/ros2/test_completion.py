"""The Tab key after `source <(grader env)`, in bash on a terminal."""

from __future__ import annotations

import os
import re
from argparse import Namespace
from pathlib import Path
from typing import TYPE_CHECKING

import pexpect
import pytest

from grader.graph.graph_info import Look, NodeLook
from grader.ros2 import completion
from grader.tests.ros2.world import World, world
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from collections.abc import Iterator


@pytest.fixture(scope="module")
def beside(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    for made in world(tmp_path_factory.mktemp("completion")):
        made.turtlesim()
        yield made


@pytest.fixture(scope="module")
def shell(beside: World) -> Iterator[pexpect.spawn]:
    cache = os.environ.get("XDG_CACHE_HOME", str(Path.home() / ".cache"))
    # Use the environment of a new terminal. The sourced file adds ROS 2.
    kept = {name: beside.env[name] for name in ("PATH", "HOME", "LANG", "TERM", "GRADER_ROS2_DAEMON")}
    # Use a wide terminal, so that bash does not scroll the line.
    size = (24, 500)
    bash = pexpect.spawn(
        "bash",
        ["--norc", "--noprofile", "-i"],
        env={**kept, "XDG_CACHE_HOME": cache},
        cwd=beside.home,
        encoding="utf-8",
        timeout=HANG_S,
        dimensions=size,
    )
    bash.sendline("bind 'set bell-style none'; PS1=ready'> '")
    bash.expect("ready> ")
    bash.sendline(f"source <(grader env --domain {beside.env['ROS_DOMAIN_ID']}) && echo sourced''!")
    bash.expect("sourced!")
    bash.expect("ready> ")
    yield bash
    bash.close(force=True)


@pytest.mark.parametrize(
    ("typed", "completed"),
    [
        ("ros2 inter", "ros2 interface "),
        ("ros2 topic ec", "ros2 topic echo "),
        ("ros2 run turtlesim turtlesim_", "ros2 run turtlesim turtlesim_node "),
        ("ros2 run turtles", "ros2 run turtlesim "),
        ("ros2 interface show geometry_msgs/msg/Twi", "ros2 interface show geometry_msgs/msg/Twist"),
        ("ros2 topic info /turtle1/cm", "ros2 topic info /turtle1/cmd_vel "),
        ("ros2 topic pub /pose turtlesim/msg/Po", "ros2 topic pub /pose turtlesim/msg/Pose "),
        ("ros2 node info /turt", "ros2 node info /turtlesim "),
        ("ros2 service call /spa", "ros2 service call /spawn "),
        ("ros2 service call /spawn turtlesim/srv/Sp", "ros2 service call /spawn turtlesim/srv/Spawn "),
        ("ros2 action send_goal /turtle1/rot", "ros2 action send_goal /turtle1/rotate_absolute "),
        ("ros2 param get /turtlesim holo", "ros2 param get /turtlesim holonomic "),
        ("ros2 pkg executables turtles", "ros2 pkg executables turtlesim "),
        ("grader hin", "grader hint "),
        ("grader start 03", "grader start 03-circle-publisher "),
        ("rqt_graph --out", "rqt_graph --output "),
        ("rqt_console --po", "rqt_console --port "),
        ("rqt_plot /turtle1/pose/the", "rqt_plot /turtle1/pose/theta "),
    ],
)
def test_tab_completes(shell: pexpect.spawn, typed: str, completed: str) -> None:
    shell.send(f"{typed}\t")
    try:
        shell.expect(re.escape(completed))
    finally:
        # Delete the line.
        shell.send("\x15")
        shell.sendline("echo next''!")
        shell.expect("next!")
        shell.expect("ready> ")


@pytest.mark.parametrize("option", ["include_hidden_nodes", "include_hidden"])
def test_hidden_nodes_are_completed_with_the_option_of_the_verb(monkeypatch: pytest.MonkeyPatch, option: str) -> None:
    monkeypatch.setattr(completion, "_look", lambda: Look(nodes=(NodeLook("/_tool"), NodeLook("/turtlesim"))))
    assert completion.nodes(Namespace(**{option: True})) == ["/_tool", "/turtlesim"]
    assert completion.nodes(Namespace(**{option: False})) == ["/turtlesim"]
    assert completion.nodes(Namespace()) == ["/turtlesim"]
