"""The verb `action send_goal`: send a goal, and wait for its result; Ctrl-C cancels it."""

from __future__ import annotations

import sys
import textwrap
import time
from typing import TYPE_CHECKING, Any

from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient, get_action_names_and_types

from grader.graph.discovery import cli_node, settle, spin_until
from grader.graph.names import absolute
from grader.ros import values
from grader.ros.failure import Ros2Error, did_you_mean

if TYPE_CHECKING:
    import argparse

_CANCEL_S = 2.0
_STATUS = {
    getattr(GoalStatus, f"STATUS_{name}"): name
    for name in ("UNKNOWN", "ACCEPTED", "EXECUTING", "CANCELING", "SUCCEEDED", "CANCELED", "ABORTED")
}


def send_goal(args: argparse.Namespace) -> int:
    """Send it; 0 when it was accepted, whatever came of it."""
    made = values.load_type(args.action_type, "action", "action type")
    goal = values.fill(made.Goal(), values.parse(args.goal))
    name = absolute(args.action_name)
    with cli_node() as node:
        client = ActionClient(node, made, name)
        try:
            print("Waiting for an action server to become available...", flush=True)
            settle(node, client.server_is_ready)
            if not client.server_is_ready():
                known = [known for known, _ in get_action_names_and_types(node) if known != name]
                hint = did_you_mean(name, known)
                print(hint, file=sys.stderr, flush=True) if hint else None
            while not client.server_is_ready():
                time.sleep(0.02)
            return _follow(node, client, goal, feedback=args.feedback)
        finally:
            client.destroy()


def _follow(node: Any, client: Any, goal: Any, *, feedback: bool) -> int:  # noqa: ANN401
    def told(message: Any) -> None:  # noqa: ANN401
        print(f"Feedback:\n{_indented(message.feedback, 4)}\n", flush=True)

    print(f"Sending goal:\n{_indented(goal, 5)}\n", end="", flush=True)
    sent = client.send_goal_async(goal, feedback_callback=told if feedback else None)
    spin_until(node, sent.done)
    handle = sent.result()
    if not handle.accepted:
        message = "Goal was rejected."
        raise Ros2Error(message)
    print(f"\nGoal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n", flush=True)
    finished = handle.get_result_async()
    try:
        spin_until(node, finished.done)
    except KeyboardInterrupt:
        cancelled = handle.cancel_goal_async()
        spin_until(node, cancelled.done, _CANCEL_S)
        raise
    answer = finished.result()
    print(f"Result:\n{_indented(answer.result, 4)}\n\nGoal finished with status: {_STATUS[answer.status]}", flush=True)
    return 0


def _indented(message: Any, columns: int) -> str:  # noqa: ANN401
    return textwrap.indent(values.to_yaml(message).rstrip("\n"), " " * columns)
