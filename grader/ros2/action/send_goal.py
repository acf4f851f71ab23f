"""The verb `action send_goal`: send a goal and wait for its result. Ctrl-C cancels the goal."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Any

from grader.common.interrupts import stops_deferred
from grader.graph.names import absolute
from grader.ros import message_values
from grader.ros.failure import Ros2Error, did_you_mean
from grader.ros.rendering import Form, to_yaml
from grader.ros2.completion import action_types, actions, completes, prototype
from grader.ros2.given_file import standard_input

if TYPE_CHECKING:
    import argparse

_CANCEL_S = 8.0
"""The maximum time (s) to wait for the action server after Ctrl-C, which is less than `main.ENDS_S`. A second Ctrl-C
ends the wait."""
_SILENT = "The action server did not respond, so it may still execute the goal."
_POLL_S = 0.02
_STATUS = ("UNKNOWN", "ACCEPTED", "EXECUTING", "CANCELING", "SUCCEEDED", "CANCELED", "ABORTED")
"""The names of the goal statuses, indexed by their numbers in action_msgs/msg/GoalStatus."""
_WHOLE = Form(limit=None)


def add(parser: argparse.ArgumentParser) -> None:
    """Add the arguments."""
    completes(parser.add_argument("action_name", help="name, such as /turtle1/rotate_absolute"), actions)
    kind = parser.add_argument("action_type", help="type of the action, such as turtlesim/action/RotateAbsolute")
    completes(kind, action_types)
    source = parser.add_mutually_exclusive_group()
    given = source.add_argument(
        "goal",
        nargs="?",
        default="{}",
        help='the goal, such as "{theta: 1.57}"; missing fields get their default values',
    )
    completes(given, prototype("action_type", "action", "Goal"))
    source.add_argument("--stdin", action="store_true", help="read the goal from standard input")
    parser.add_argument("-f", "--feedback", action="store_true", help="print the feedback while the goal is executed")


def run(args: argparse.Namespace) -> int:
    """Send the goal. Return 0 regardless of the goal's result.

    Raises:
        Ros2Error: the name is invalid, the type is not installed, or the goal cannot be read or does not match the
            type.
    """
    from rclpy.action import ActionClient, get_action_names_and_types

    from grader.graph.discovery import cli_node, settle

    made = message_values.load_type(args.action_type, "action", "action type")
    given = message_values.parse(standard_input() if args.stdin else args.goal, dictionary=False)
    try:
        goal = message_values.fill(made.Goal(), given)
    except message_values.MisfitError as error:
        message = "\n".join(
            part for part in (f"Failed to populate message fields: {error.cause!r}", error.help) if part
        )
        raise Ros2Error(message) from error
    name = absolute(args.action_name)
    with cli_node(f"_ros2cli_send_goal_{args.action_type.replace('/', '_')}") as node:
        try:
            client = ActionClient(node, made, name)
        except Exception as error:
            message = f"The action '{args.action_name}' cannot be used: {str(error).partition(', at ')[0]}"
            raise Ros2Error(message) from error
        try:
            print("Waiting for an action server to become available...", flush=True)
            settle(node, client.server_is_ready)
            if not client.server_is_ready():
                known = [known for known, _ in get_action_names_and_types(node) if known != name]
                hint = did_you_mean(name, known)
                print(hint, file=sys.stderr, flush=True) if hint else None
            while not client.server_is_ready():
                time.sleep(_POLL_S)
            _follow(node, client, goal, feedback=args.feedback)
        finally:
            client.destroy()
    return 0


def _follow(node: Any, client: Any, goal: Any, *, feedback: bool) -> None:  # noqa: ANN401
    from grader.graph.discovery import spin_until

    def print_feedback(message: Any) -> None:  # noqa: ANN401
        print(f"Feedback:\n    {to_yaml(message.feedback, _WHOLE)}", flush=True)

    sent: Any = None
    try:
        with stops_deferred():
            print(f"Sending goal:\n     {to_yaml(goal, _WHOLE)}", flush=True)
            sent = client.send_goal_async(goal, feedback_callback=print_feedback if feedback else None)
        spin_until(node, sent.done, defer_stops=True)
        handle = sent.result()
        if not handle.accepted:
            print("Goal was rejected.", flush=True)
            return
        print(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n", flush=True)
        with stops_deferred():
            finished = handle.get_result_async()
        spin_until(node, finished.done, defer_stops=True)
    except KeyboardInterrupt:
        if sent is not None:
            _cancel(node, sent)
        raise
    answer = finished.result()
    print(f"Result:\n    {to_yaml(answer.result, _WHOLE)}", flush=True)
    print(f"Goal finished with status: {_STATUS[answer.status]}", flush=True)


def _cancel(node: Any, sent: Any) -> None:  # noqa: ANN401
    """Cancel the goal that was sent, unless the server rejects it. If the server does not respond in time, say so."""
    from grader.graph.discovery import spin_until

    end = time.monotonic() + _CANCEL_S

    def answered(future: Any) -> bool:  # noqa: ANN401
        if not spin_until(node, future.done, end - time.monotonic(), defer_stops=True):
            print(_SILENT, file=sys.stderr, flush=True)
            return False
        return True

    if not answered(sent) or not sent.result().accepted:
        return
    print("Canceling goal...", flush=True)
    with stops_deferred():
        canceled = sent.result().cancel_goal_async()
    if answered(canceled) and canceled.result().goals_canceling:
        print("Goal canceled.", flush=True)
