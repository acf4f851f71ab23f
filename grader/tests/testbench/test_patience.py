"""A run that can never continue is ended early, but a slow run is not."""

from __future__ import annotations

import time
from types import SimpleNamespace

import pytest

from grader.sandbox import bubblewrap
from grader.testbench import bench
from grader.testbench.conversation import LATEST
from grader.tests.testbench.bench_runs import TESTS, all_ended, run, spec

pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")
SPINS = """
import rclpy
from rclpy.parameter import Parameter
from my_robot_controller.wall_guard import WallGuard

def test_it():
    rclpy.init()
    guard = WallGuard()
    guard.set_parameters([Parameter("use_sim_time", value=True)])
    rclpy.spin(guard)
"""
WAITS_FOR_ITSELF = "import threading\n\ndef test_it():\n    threading.Lock().acquire() and threading.Event().wait()\n"
SLEEPS = "import time\n\ndef test_it():\n    time.sleep(600)\n"
LOOPS = "def test_it():\n    while True:\n        pass\n"
WAITS_FOR_A_CHILD = "import subprocess\n\ndef test_it():\n    subprocess.run(['sleep', '600'])\n"


@pytest.mark.parametrize("code", [SPINS, WAITS_FOR_ITSELF], ids=["spins", "waits for itself"])
def test_a_run_that_can_never_go_on_is_ended_early(
    code: str, files: dict[str, bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The limits are so long that only this rule can end the runs."""
    for limit in ("RIGHT_S", "DOUBT_S"):
        monkeypatch.setattr(bench, limit, 120.0)
    nodes = spec("rate", "stop", right_runs=3, duration_s=600.0)
    runs = all_ended(nodes, {**files, TESTS: code.encode()}, lanes=2)
    assert [each.node for each in runs if not each.node] == [""]
    assert all(each.over and each.stuck for each in runs)


@pytest.mark.parametrize("code", [SLEEPS, LOOPS, WAITS_FOR_A_CHILD], ids=["sleeps", "loops", "waits for a child"])
def test_a_run_that_hangs_is_ended(code: str, files: dict[str, bytes], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bench, "RIGHT_S", 1.5)
    runs = run(spec("rate", "stop", right_runs=3), {**files, TESTS: code.encode()})
    assert [(each.node, each.over, each.accepted) for each in runs] == [("", True, False)]


CROWD = """
import os

def test_it():
    for _ in range(16):
        if os.fork() == 0:
            os.setsid()
            while True:
                pass
    while True:
        pass
"""


def test_a_run_gains_no_time_by_keeping_the_processors_busy(files: dict[str, bytes]) -> None:
    """The first process of the run waits for a processor most of the time, and only because of its own children."""
    nodes = spec(right_runs=1, duration_s=4.0)
    (only,) = run(nodes, {**files, TESTS: CROWD.encode()})
    assert only.over
    assert only.seconds < LATEST * nodes.duration_s


def test_a_run_is_ended_at_the_latest_time(files: dict[str, bytes], monkeypatch: pytest.MonkeyPatch) -> None:
    """Otherwise its cell would go on, and the next run would have to wait for it. In this test, time jumps."""
    jumps: list[float] = []

    def jump(_: object) -> bool:
        jumps.append(1000.0)
        return False

    clock = SimpleNamespace(monotonic=lambda: time.monotonic() + sum(jumps))
    monkeypatch.setattr("grader.testbench.conversation.time", clock)
    monkeypatch.setattr("grader.testbench.patience.Patience.is_over", jump)
    runs = run(spec("rate", right_runs=1, duration_s=0.5), {**files, TESTS: SLEEPS.encode()})
    assert [each.over for each in runs if not each.node] == [True]
    assert jumps


ALARM = """
import signal, threading

def test_it():
    def stop(*_):
        raise InterruptedError
    signal.signal(signal.SIGALRM, stop)
    try:
        signal.alarm(2)
        threading.Event().wait()
    except InterruptedError:
        pass
"""
SECOND_THREAD = """
import threading
import rclpy
from my_robot_controller.wall_guard import WallGuard

def test_it():
    rclpy.init()
    guard = WallGuard()
    event, timer = threading.Event(), threading.Event()
    threading.Thread(target=lambda: (timer.wait(2.5), event.set())).start()
    event.wait()
    rclpy.shutdown()
"""
CHILD = "import subprocess\n\ndef test_it():\n    subprocess.run(['sleep', '2'])\n"
MANY_TESTS = """
import time
import pytest

@pytest.mark.parametrize("number", range(4))
def test_it(number):
    time.sleep(0.8)
"""


@pytest.mark.parametrize(
    "code", [ALARM, SECOND_THREAD, CHILD, MANY_TESTS], ids=["an alarm", "a thread", "a child", "many tests"]
)
def test_a_run_that_waits_for_something_is_not_ended(code: str, files: dict[str, bytes]) -> None:
    runs = run(spec(right_runs=1), {**files, TESTS: code.encode()})
    assert [(each.over, each.exit_code, each.message) for each in runs] == [(False, 0, "")]


PATIENT = """
import time
from rclpy.node import Node
import rclpy
from geometry_msgs.msg import Twist
from rclpy.parameter import Parameter
from turtlesim.msg import Pose
from my_robot_controller.wall_guard import WallGuard

def test_it():
    rclpy.init()
    guard, other, heard = WallGuard(), Node("other"), []
    other.create_subscription(Twist, "/turtle1/cmd_vel", heard.append, 10)
    poses = other.create_publisher(Pose, "/turtle1/pose", 10)
    until, rounds = time.monotonic() + 3.0, 0
    while not heard and (time.monotonic() < until or rounds < 30):  # on a busy machine, a round takes longer
        rounds += 1
        poses.publish(Pose(x=5.0, y=5.0))
        for node in (guard, other):
            rclpy.spin_once(node, timeout_sec=0.05)
    rclpy.shutdown()
    assert heard
"""


def test_a_test_with_a_deadline_rejects_a_silent_node(files: dict[str, bytes]) -> None:
    """On a broken node, a test may wait longer than DOUBT_S: it has time as soon as the correct node was accepted."""
    begun = time.monotonic()
    runs = run(spec("silent", "topic", right_runs=2), {**files, TESTS: PATIENT.encode()})
    assert time.monotonic() - begun > 6.0
    found = {each.node: (each.over, each.exit_code) for each in runs}
    assert found == {"": (False, 0), "silent": (False, 1), "topic": (False, 1)}


LOOPS_FOR_SILENT = PATIENT.replace("and (time.monotonic() < until or rounds < 30)", "")


def test_a_test_that_hangs_on_broken_nodes_only_still_accepts_the_right_node(files: dict[str, bytes]) -> None:
    nodes = spec("silent", "topic", "type", right_runs=2, duration_s=3.0)
    runs = run(nodes, {**files, TESTS: LOOPS_FOR_SILENT.encode()})
    assert [each.accepted for each in runs if not each.node] == [True] * len([each for each in runs if not each.node])
    assert sum(not each.node for each in runs) >= 2
    assert sum(each.over for each in runs) == bench.MOST_HANGS
