"""Functions for tests of a trial. The functions run in a process that has rclpy (in_ros.py)."""

from __future__ import annotations

import os
import time
from pathlib import Path
from types import SimpleNamespace
from typing import Any
from unittest.mock import patch

import rclpy
from geometry_msgs.msg import Twist
from rclpy.action import ActionClient
from turtlesim.action import RotateAbsolute
from turtlesim.srv import Spawn

from grader.tests.waiting import HANG_S, until
from grader.trial import simulated, wall
from grader.trial.inputs import Inputs
from grader.trial.recording import Pose
from grader.trial.rest import DoubtError, Look
from grader.trial.silent_servers import SilentServers
from grader.trial.simulated import QUIET_S, SimulatedTrial
from grader.trial.wall import WallTrial
from grader.trial.without_node import AloneTrial

LIMIT_S = 0.25


def what_one_spin_handles() -> dict[str, Any]:
    """Return how many of three commands are kept in one spin, and which log lines are received during a request."""
    stage = _stage()
    student = rclpy.create_node("student")
    commands = student.create_publisher(Twist, "/turtle1/cmd_vel", 10)
    spawn = student.create_client(Spawn, "/spawn")
    until(lambda: commands.get_subscription_count() > 0 and spawn.service_is_ready())
    stage.recorder.follow_graph()
    until(lambda: bool(stage.spin(0.1)) and bool(stage.recorder.log))  # from here on, /rosout is received
    for _ in range(3):
        commands.publish(Twist())
    until(lambda: bool(stage.spin(0.1)) and bool(stage.recorder.commands))
    kept = len(stage.recorder.commands)
    spawn.call_async(Spawn.Request(x=1.0, y=1.0, name="turtle2"))
    until(lambda: bool(stage.spin()) and bool(stage.interventions))
    return {"commands": kept, "log": [line.text for line in stage.recorder.log], "after": len(stage.spin())}


def a_line_while_the_graph_is_looked_at() -> list[float]:
    """Return the times (s) that are stored for lines that the node prints just before the clock starts."""
    written: list[str] = []
    taken_in_s: list[float] = []

    def read(now_s: float) -> int:
        size = len(written)
        taken_in_s.extend([now_s] * size)
        written.clear()
        return size

    stage: Any = WallTrial.__new__(WallTrial)
    stage.node = SimpleNamespace(pids=(1,), ended=lambda: False, read_output=read)
    stage.recorder = SimpleNamespace(commands=[])
    stage.follow_graph = lambda: written.append("a line")
    stage.spin = lambda _=0.0: []
    stage.students_nodes = lambda: ["/draw_circle"]
    stage._discover()
    return taken_in_s


def a_node_that_drives_before_it_is_found() -> int:
    """Return how many commands have arrived when the clock starts, for a node that drives before it is discovered."""
    commands: list[str] = []
    stage: Any = WallTrial.__new__(WallTrial)
    stage.node = SimpleNamespace(pids=(1,), ended=lambda: False, read_output=lambda _: 0)
    stage.recorder = SimpleNamespace(commands=commands)
    stage.follow_graph = lambda: True
    stage.spin = lambda _=0.0: commands.append("a command")
    stage.students_nodes = lambda: ["/draw_square"]
    stage._discover()
    return len(commands)


def periods_that_count_as_stalls() -> dict[str, bool]:
    """Return whether the whole trial counts as a stall, if the system's clock is left alone, set, or set twice."""
    set_by_s = {"left alone": (0.0,), "set": (-3600.0,), "set and set again": (3600.0, 0.0)}
    return {name: _counts_as_a_stall(list(ahead_s)) for name, ahead_s in set_by_s.items()}


def _counts_as_a_stall(ahead_s: list[float]) -> bool:
    real = time.time
    stage: Any = WallTrial.__new__(WallTrial)
    stage.node = SimpleNamespace(pids=(), ended=lambda: False, read_output=lambda _: 0, worked_s=lambda *_: 0.0)
    stage.recorder = SimpleNamespace(snapshot=lambda: None)
    stage.stalls, stage.seconds, stage._since = [], {}, 0.0
    stage._discover = stage.wind_down = stage.follow_graph = lambda: None
    stage.is_over, stage.spin = (lambda _: False), time.sleep
    with patch("time.time", lambda: real() + (ahead_s[0] if stage._begun else 0.0)):
        stage.frame = lambda _: ahead_s.pop(0) if len(ahead_s) > 1 else None
        stopped_s = stage.run(0.05)
    return bool(stage.unreliable == ((0.0, stopped_s),))


def who_is_found_after_the_limit() -> dict[str, bool]:
    """Return whether the clock waits for a node that starts after the time limit.

    In one case, the node has slept for this time. In the other case, it has waited for a processor. The clock of the
    system stands still, except while the trial waits for messages.
    """

    def found(*, asleep: bool) -> bool:
        now_s = [0.0]

        def spin(timeout_s: float = 0.0) -> None:
            now_s[0] += timeout_s

        stage: Any = WallTrial.__new__(WallTrial)
        stage.node = SimpleNamespace(pids=(1,), ended=lambda: False, read_output=lambda _: 0)
        stage.recorder = SimpleNamespace(commands=[])
        stage.follow_graph = lambda: False
        stage.spin = spin
        stage.all_nodes_found = lambda: now_s[0] > 4.0 * LIMIT_S
        threads = SimpleNamespace(look=lambda: Look(asleep, ()), run_time_s=lambda: 0.0, close=lambda: None)
        with (
            patch.object(wall, "DISCOVERY_S", LIMIT_S),
            patch.object(wall, "GroupThreads", lambda _: threads),
            patch.object(wall, "time", SimpleNamespace(monotonic=lambda: now_s[0])),
        ):
            stage._discover()
        return bool(stage.all_nodes_found())

    return {"asleep": found(asleep=True), "waiting": found(asleep=False)}


def who_may_act() -> bool:
    """Return whether `may_act` is true before any action client exists.

    While an action client exists, `may_act` must be true.
    """
    stage = _stage()
    student = rclpy.create_node("student")
    anybody = stage.may_act()

    def act(turtle: str) -> None:
        client = ActionClient(student, RotateAbsolute, f"/{turtle}/rotate_absolute")
        until(stage.may_act)
        client.destroy()
        until(lambda: not stage.may_act())

    act("turtle1")
    spawn = student.create_client(Spawn, "/spawn")
    until(spawn.service_is_ready)
    anybody |= stage.may_act()
    spawn.call_async(Spawn.Request(x=1.0, y=1.0, name="turtle2"))
    until(lambda: bool(stage.take_in()))
    act("turtle2")
    return anybody


def a_request_without_an_executor() -> dict[str, Any]:
    """Return the record of a request that the method `take_in` answers, and the response that the client gets."""
    stage = _stage()
    student = rclpy.create_node("student")
    spawn = student.create_client(Spawn, "/spawn")
    until(spawn.service_is_ready)
    stage.recorder.follow_graph()
    until(lambda: bool(stage.take_in()) or bool(stage.recorder.log))  # from here on, /rosout is received
    future = spawn.call_async(Spawn.Request(x=1.0, y=1.0, name="turtle2"))
    until(lambda: stage.take_in() > 0)
    rclpy.spin_until_future_complete(student, future, timeout_sec=HANG_S)
    response = future.result()
    return {
        "requests": stage.requests,
        "calls": [(call.service, dict(call.request)["name"]) for call in stage.calls],
        "log": stage.recorder.log[-1].text,
        "name": response and response.name,
    }


def a_call_between_two_nodes() -> dict[str, Any]:
    """Return a silent server's record of a call between two nodes, and the response that the client gets."""
    stage = _stage()
    recorded: list[tuple[str, str, str]] = []
    prefixes = [Path(prefix) for prefix in os.environ["AMENT_PREFIX_PATH"].split(os.pathsep)]
    silent = SilentServers(
        stage.recorder, prefixes, lambda *call: recorded.append((*call[:2], call[2].name)), lambda *_: False
    )
    student = rclpy.create_node("student")

    def spawn(request: Any, response: Any) -> Any:  # noqa: ANN401 - ROS messages
        response.name = request.name.upper()
        return response

    student.create_service(Spawn, "/lay", spawn)
    until(lambda: not stage.spin(0.1) and silent.follow())
    client = student.create_client(Spawn, "/lay")
    until(lambda: stage.recorder.count_clients("/lay") == 1 and client.service_is_ready())
    future = client.call_async(Spawn.Request(name="egg"))
    until(lambda: bool(stage.take_in() or recorded))
    rclpy.spin_until_future_complete(student, future, timeout_sec=HANG_S)
    response = future.result()
    return {"recorded": recorded, "again": silent.follow(), "name": response and response.name}


def graphs_of_two_nodes() -> dict[str, Any]:
    """Return the publishers on /x in each snapshot, and the number of queries that a snapshot without news makes."""
    stage = _stage()
    first, second = rclpy.create_node("first"), rclpy.create_node("second")
    recorder = stage.recorder
    asked: list[str] = []

    def publishers() -> list[str]:
        recorder.snapshot()
        return [end.node for end in recorder.graphs[-1].endpoints if (end.kind, end.topic) == ("publisher", "/x")]

    found: dict[str, Any] = {}
    of_first = first.create_publisher(Twist, "/x", 10)
    until(lambda: publishers() == ["/first"] and {"/first", "/second"} <= set(recorder.nodes()))
    publishers()
    query = recorder.get_publishers_info_by_topic

    def count(topic: str) -> Any:  # noqa: ANN401
        asked.append(topic)
        return query(topic)

    recorder.get_publishers_info_by_topic = count
    found["without news"] = publishers()
    found["queries"] = len(asked)
    second.create_publisher(Twist, "/x", 10)
    until(lambda: recorder.count_publishers("/x") == 2)
    found["another"] = publishers()
    first.destroy_publisher(of_first)
    until(lambda: recorder.count_publishers("/x") == 1)
    found["one less"] = publishers()
    return found


def what_is_in_doubt() -> dict[str, list[Any] | None]:
    """Return the doubt about a node, and whether it may have arisen by chance, or None if there is no doubt."""

    def doubt(*, late: bool = False, started: bool = False, ending: bool = False) -> list[Any] | None:
        stage: Any = SimulatedTrial.__new__(SimulatedTrial)
        stage.doubts, stage._stop_at_doubt = [], True
        stage._node = SimpleNamespace(waits=list)
        stage.node = SimpleNamespace(pids=(1,), has_started_others=lambda: started)
        stage._respond, stage._is_ending = (lambda _: None), (lambda: ending)
        patience = SimpleNamespace(would_be_late=lambda: late)
        try:
            with patch.object(simulated, "TickPatience", lambda *_: patience):
                stage._settle()
            stage._doubt_sleepers()
        except DoubtError as error:
            return [str(error), error.by_chance]
        return None

    return {
        "late": doubt(late=True),
        "another process": doubt(started=True),
        "another process at the end": doubt(started=True, ending=True),
        "nothing": doubt(),
    }


def quiet_s() -> float:
    """Return how long discovery must be silent before it counts as finished (s)."""
    return QUIET_S


def _stage() -> AloneTrial:
    prefixes = [Path(prefix) for prefix in os.environ["AMENT_PREFIX_PATH"].split(os.pathsep)]
    return AloneTrial(Pose(5.5, 5.5, 0.0), prefixes, Inputs())
