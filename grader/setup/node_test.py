"""Test the interpreter, ROS 2, the network and the interfaces: one node publishes to another, as in a trial."""

from __future__ import annotations

import os
import secrets
import shlex
import subprocess
from typing import TYPE_CHECKING

from grader.common.interpreter import interpreter
from grader.common.temporary_folder import temporary_folder
from grader.ros.installation import FASTDDS_PROFILE, Ros, environment
from grader.sandbox import bubblewrap
from grader.sandbox.user import cell_user

if TYPE_CHECKING:
    from collections.abc import Mapping

_TALKER = """
import sys, rclpy, turtlesim.msg, turtlesim.srv
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("talker")
publisher = node.create_publisher(String, sys.argv[1], 10)
node.create_timer(0.05, lambda: publisher.publish(String(data="well")))
rclpy.spin(node)
"""
_LISTENER = """
import sys, time, rclpy
from std_msgs.msg import String
rclpy.init()
node = rclpy.create_node("listener")
heard = []
node.create_subscription(String, sys.argv[1], heard.append, 10)
deadline = time.monotonic() + 20.0
while not heard and time.monotonic() < deadline:
    rclpy.spin_once(node, timeout_sec=0.5)
sys.exit(None if heard else "no message arrived within 20 s")
"""
DOMAIN = 101
"""The ROS domain of nodes outside a cell. Trials use this domain only if all other domains are in use."""


def why_not_heard(ros: Ros, *, confined: bool) -> str | None:
    """Publish for up to 20 s. Return None if another node received a message, and otherwise the reason for the failure.

    The reason is the last line of the error output if there is one.

    If `confined` is True, the publisher is in a cell, and the other node is outside.
    """
    with temporary_folder() as home, cell_user() as user:
        if confined:
            command, env = _talk_from_a_cell(ros, user), dict(os.environ)
        else:
            env = environment(ros, home=home, domain=DOMAIN)
            talker, listener = _talker_and_listener(ros, env)
            command = ["sh", "-c", f"setpriv --pdeathsig=KILL {shlex.join(talker)} & exec {shlex.join(listener)}"]
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, timeout=60, check=False, stdin=subprocess.DEVNULL, env=env
            )
        except subprocess.TimeoutExpired:
            return "no response within 60 s"
    if done.returncode == 0:
        return None
    return (done.stderr.strip().splitlines()[-1:] or [f"exit code {done.returncode}"])[0]


def _talk_from_a_cell(ros: Ros, user: int | None) -> list[str]:
    env = environment(ros, home=bubblewrap.HOME, domain=None)
    view = bubblewrap.ros_view(ros, FASTDDS_PROFILE)
    talker, listener = _talker_and_listener(ros, env)
    confined = bubblewrap.cell(talker, view, env=env, network=True)
    # The talker exits together with the listener, because cells are killed when their parent exits.
    script = f"{shlex.join(confined)} & exec {shlex.join(listener)}"
    return bubblewrap.room(["sh", "-c", script], view, env=env, user=user)


def _talker_and_listener(ros: Ros, env: Mapping[str, str]) -> tuple[list[str], list[str]]:
    # Nodes outside a cell would also receive the messages of another `grader doctor` that is running.
    topic = f"doctor_{secrets.token_hex(8)}"
    talker, listener = (
        interpreter("-c", code, topic, python=str(ros.python), env=env, searches=True) for code in (_TALKER, _LISTENER)
    )
    return talker.argv, listener.argv
