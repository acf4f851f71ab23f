"""Several nodes run in one trial: they receive each other's messages, keep their own output, and end together."""

from __future__ import annotations

import io
import tarfile
from typing import TYPE_CHECKING

import pytest

from grader.errors import MachineError
from grader.evidence import activity, student_log
from grader.evidence.trajectory import trajectory_of
from grader.ros.installation import find_ros
from grader.ros.underlay import with_turtlesim
from grader.tests.waiting import until_gone
from grader.trial.inputs import Inputs, PlannedCall
from grader.trial.recording import Pose, Recording
from grader.trial.recording_json import from_json, to_json
from grader.trial.target_places import Target, draw_targets
from grader.trial.trial import Plan, Trial

if TYPE_CHECKING:
    from pathlib import Path

    from grader.trial.recording import ClockName

PACKAGE = "my_package"
START = Pose(5.544445, 5.544445, 0.0)
NODE = """#!/usr/bin/env python3
import rclpy
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import String
from turtlesim.srv import Kill

rclpy.init()
node = rclpy.create_node("{name}")
{body}
print("hello from {name}", flush=True)
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
"""
PING = """
publisher = node.create_publisher(String, "/ping", 10)
node.create_timer(0.5, lambda: publisher.publish(String(data="ping")))
"""
PONG = """
publisher = node.create_publisher(String, "/pong", 10)
node.create_subscription(String, "/ping", publisher.publish, 10)
"""
ENDS = """
node.create_timer(1.0, lambda: exit(0))
"""
LEAVES = """
from geometry_msgs.msg import Twist
publisher = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)
def drive():
    msg = Twist()
    msg.linear.x = 2.0
    publisher.publish(msg)
    node.destroy_node()
    rclpy.shutdown()
    exit(0)
node.create_timer(0.5, drive)
"""
STOPS = """
import atexit, time
def stop():
    print(time.monotonic())
    time.sleep(0.2)
    print(time.monotonic())
atexit.register(stop)
"""
TURNS = """
import threading
def turn():
    while True:
        pass
node.create_timer(0.8, lambda: threading.Thread(target=turn, daemon=True).start())
"""
LEAVES_A_CHILD = """
import subprocess
child = subprocess.Popen(["sleep", "300"], start_new_session=True, stdout=subprocess.DEVNULL)
print(child.pid, flush=True)
"""
KILLS_THE_CONDUCTOR = """
import os, pathlib
pathlib.Path("{pid}").write_text(str(os.getpid()))
os.kill(os.getppid(), 9)
"""
LEAVES_SLOWLY = LEAVES.replace("    exit", "    __import__('subprocess').run(['sleep', '2'])\n    exit")
CATCHER = """
client = node.create_client(Kill, "/catch")
def hear(msg):
    print(msg.data, flush=True)
    for name in msg.data.split()[:1]:
        client.call_async(Kill.Request(name=name))
node.create_subscription(String, "/targets", hear, 10)
"""
SAYS_AND_ASKS = """
def ask():
    node.get_logger().info("before the call")
    client.call_async(Kill.Request(name="nobody"))
    timer.cancel()
timer = node.create_timer(1.0, ask)
"""
DRIVES = """
from geometry_msgs.msg import Twist, Vector3
publisher = node.create_publisher(Twist, "/turtle1/cmd_vel", 10)
node.create_timer(0.1, lambda: publisher.publish(Twist(linear=Vector3(x=0.5))))
"""


LAYS = """
from turtlesim.srv import Spawn
def lay(request, response):
    response.name = request.name.upper()
    return response
server = node.create_service(Spawn, "/lay", lay)
"""
ASKS = """
from turtlesim.srv import Spawn
client = node.create_client(Spawn, "/lay")
node.create_timer(1.0, lambda: client.call_async(Spawn.Request(name="egg")))
"""
WITHDRAWS = """
timer = node.create_timer(1.5, lambda: (node.destroy_service(server), timer.cancel()))
"""


def trial_of(
    inputs: Inputs, duration_s: float = 4.0, *, clock: ClockName = "simulated", in_cell: bool = True, **bodies: str
) -> Recording:
    """Return the recording of one trial in which a node with each of these bodies runs."""
    stream = io.BytesIO()
    with tarfile.open(fileobj=stream, mode="w|") as tar:
        for name, body in bodies.items():
            source = NODE.format(name=name, body=body).encode()
            member = tarfile.TarInfo(f"./{PACKAGE}/lib/{PACKAGE}/{name}")
            member.size, member.mode = len(source), 0o755
            tar.addfile(member, io.BytesIO(source))
    first, *others = bodies
    plan = Plan(clock, START, None, duration_s, inputs=inputs, beside=tuple(others))
    with Trial(plan, with_turtlesim(find_ros()), in_cell=in_cell) as trial:
        return trial.run(PACKAGE, first, stream.getvalue())


def eggs(*at_s: float) -> Inputs:
    """Return inputs in which the trial calls /lay at these times (s), with the request that ASKS sends."""
    request = {"name": "egg"}
    return Inputs(calls=tuple(PlannedCall(each, "/lay", "turtlesim/srv/Spawn", request) for each in at_s))


@pytest.fixture(scope="module")
def both() -> Recording:
    return trial_of(Inputs(), ping=PING, pong=PONG)


def test_the_nodes_of_a_trial_hear_each_other_in_simulated_time(both: Recording) -> None:
    sent, answered = ([m.t_s for m in both.messages if m.topic == topic] for topic in ("/ping", "/pong"))
    assert sent[:7] == pytest.approx([0.5 * n for n in range(1, 8)], abs=0.02)
    assert answered[:7] == sent[:7]


def test_each_node_keeps_its_own_output_and_stops_on_ctrl_c(both: Recording) -> None:
    beside = both.seen_from("pong")
    assert (both.stdout.text, beside.stdout.text) == ("hello from ping\n", "hello from pong\n")
    assert [each.end.by for each in (both, beside)] == ["SIGINT", "SIGINT"]
    assert {"/ping", "/pong"} <= set(both.graphs[-1].nodes)
    assert from_json(to_json(both)).beside == both.beside


def test_the_nodes_are_stopped_one_after_the_other() -> None:
    recording = trial_of(Inputs(), 1.0, first=STOPS, second=STOPS, third=STOPS)
    stops = [recording.seen_from(name).stdout.text.split()[-2:] for name in ("second", "third")]
    stops.insert(0, recording.stdout.text.split()[-2:])
    times_s = [float(each) for stop in stops for each in stop]
    assert times_s == sorted(times_s), "a node was stopped before another one had exited"
    assert [end.by for end in (recording.end, *(each.end for each in recording.beside))] == ["SIGINT"] * 3


def test_a_node_that_is_never_at_rest_is_stopped_too() -> None:
    recording = trial_of(Inputs(), 1.0, clock="wall", first=PING, second=TURNS)
    assert recording.seen_from("second").end.by == "SIGINT"


def test_the_trials_own_calls_are_no_calls_between_the_nodes() -> None:
    recording = trial_of(eggs(1.0, 1.5, 2.5), 3.5, lays=LAYS, asks=ASKS)
    by_trial = [call for call in recording.calls if call.by_trial]
    assert [call.t_s for call in by_trial] == pytest.approx([1.0, 1.5, 2.5], abs=0.02)
    assert [(call.response or {}).get("name") for call in by_trial] == ["EGG"] * 3
    between = [call.t_s for call in recording.calls if not call.by_trial]
    assert between == pytest.approx([1.0, 2.0, 3.0], abs=0.05)


def test_a_service_that_its_node_has_withdrawn_is_missing_though_the_trial_listens_to_it() -> None:
    recording = trial_of(eggs(1.0, 2.0), 4.0, lays=LAYS + WITHDRAWS, ping=PING)
    assert [(call.missing, call.response is None) for call in recording.calls] == [(False, False), (True, True)]


def test_when_one_node_ends_the_trial_is_over_for_all() -> None:
    recording = trial_of(Inputs(), ping=PING, ends=ENDS)
    assert recording.seen_from("ends").end.by == "itself"
    assert recording.end.by == "SIGINT"
    assert recording.sigint_t_s < 2.0


def test_the_trial_plays_the_node_that_announces_and_removes_targets() -> None:
    targets = draw_targets(3, START, 1)
    recording = trial_of(Inputs(targets=targets, alone_s=0.5), catcher=CATCHER)
    names = [target.name for target in targets]
    assert recording.stdout.text.splitlines()[:3] == ["hello from catcher", " ".join(names), " ".join(names[1:])]
    assert [call.request["name"] for call in recording.calls if call.service == "/catch"] == names
    assert [track.turtle for track in recording.tracks if track.gone_s is not None] == names
    assert recording.own_nodes == ("/turtlesim", "/spawner")
    assert recording.sigint_t_s < 3.0  # turtle1 has been alone for long enough


def test_a_node_with_the_name_of_the_trials_own_node_keeps_its_endpoints() -> None:
    targets = draw_targets(1, START, 1)
    recording = trial_of(Inputs(targets=targets), 1.5, spawner=CATCHER)
    assert activity.nodes(recording) == ("/spawner",)
    assert [end.topic for end in activity.endpoints(recording, "subscription")] == ["/targets"]
    assert not activity.endpoints(recording, "publisher")  # the trial's own node is the publisher of /targets


def test_a_warning_of_the_node_that_removes_targets_is_not_a_line_of_the_submission() -> None:
    targets = draw_targets(1, START, 1)
    recording = trial_of(Inputs(targets=targets), 2.5, catcher=f"{CATCHER}\n{SAYS_AND_ASKS}")
    assert {line.logger for line in recording.log} == {"turtlesim", "catcher", "spawner"}
    assert [line.text for line in student_log.students(recording)] == ["before the call"]


def test_after_the_first_catch_the_trial_withdraws_another_target() -> None:
    targets = draw_targets(3, START, 1)
    names = [target.name for target in targets]
    recording = trial_of(Inputs(targets=targets, alone_s=0.5, withdrawn=(names[0], names[2])), catcher=CATCHER)
    assert recording.stdout.text.splitlines()[1:] == [" ".join(names), names[1], ""]
    assert [call.request["name"] for call in recording.calls if call.service == "/catch"] == names[:2]
    assert (recording.withdrawn, recording.catch_from_s) == ((names[2],), 0.0)
    assert from_json(to_json(recording)).withdrawn == recording.withdrawn


@pytest.mark.parametrize(("drives", "from_s"), [(False, 1.5), (True, 2.7)])
def test_a_late_service_waits_until_turtle1_has_stood_still_or_was_near_a_target(
    *, drives: bool, from_s: float
) -> None:
    targets = (Target("ada", START.x + 1.5, START.y),)
    body = CATCHER + (DRIVES if drives else "")
    recording = trial_of(Inputs(targets=targets, alone_s=0.5, catch_from_s=1.0), catcher=body)
    assert recording.catch_from_s == pytest.approx(from_s, abs=0.15)


def test_the_last_command_of_a_node_arrives_and_moves_the_turtle() -> None:
    recording = trial_of(Inputs(), 10.0, leaves=LEAVES)
    assert (recording.end.by, len(recording.commands)) == ("itself", 1)
    assert trajectory_of(recording).length_m > 0.3


def test_the_clock_stands_still_while_a_node_that_has_left_exits() -> None:
    recording = trial_of(Inputs(), 10.0, leaves=LEAVES_SLOWLY)
    assert (recording.end.by, len(recording.commands), recording.end.t_s) == ("itself", 1, 0.512)


def test_a_child_in_a_session_of_its_own_ends_with_a_trial_without_a_sandbox() -> None:
    recording = trial_of(Inputs(), 1.0, clock="wall", in_cell=False, leaves=LEAVES_A_CHILD)
    assert recording.end.by == "SIGINT"
    until_gone(int(recording.stdout.text.split()[0]))


def test_a_node_ends_with_its_conductor_without_a_sandbox(tmp_path: Path) -> None:
    pid = tmp_path / "pid"
    with pytest.raises(MachineError, match=r"killed \(SIGKILL\).* another program, such as the node, killed it"):
        trial_of(Inputs(), 1.0, in_cell=False, kills=KILLS_THE_CONDUCTOR.replace("{pid}", str(pid)))
    until_gone(int(pid.read_text("ascii")))
