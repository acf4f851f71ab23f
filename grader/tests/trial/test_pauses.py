from __future__ import annotations

import random
from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from grader.sandbox import bubblewrap
from grader.tests.trial.forks import run
from grader.tests.trial.program import python
from grader.trial.inputs import Inputs, PlannedCall
from grader.trial.launcher import PAUSES
from grader.trial.pauses import process_pause_s
from grader.trial.recording import Pose
from grader.trial.trial import Plan

if TYPE_CHECKING:
    from grader.trial.recording import Recording

in_a_cell = pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")

NODE = """#!/usr/bin/env python3
import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from turtlesim.msg import Color
from turtlesim.srv import SetPen

class Draws(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.publisher = self.create_publisher(Twist, "/turtle1/cmd_vel", 10)
        self.clocks = 0
        self.count = {{}}
{timers}

    def send(self, which):
        self.count[which] = self.count.get(which, 0) + 1
        command = Twist()
        command.linear.x, command.angular.z = float(which), float(self.count[which])
        self.publisher.publish(command)
        self.get_logger().info(f"{{which}} at {{self.get_clock().now().nanoseconds}}")

rclpy.init()
node = Draws()
{listens}
try:
    rclpy.spin(node)
except KeyboardInterrupt:
    print("clock", node.get_clock().now().nanoseconds, "heard", node.clocks)
"""
LISTENS = 'node.create_subscription(Color, "/turtle1/color_sensor", lambda _: None, 10)'
COUNTS = """
from rclpy.qos import qos_profile_sensor_data
from rosgraph_msgs.msg import Clock
def count(_): node.clocks += 1
node.create_subscription(Clock, "/clock", count, qos_profile_sensor_data)
"""
ANOTHER = """
from threading import Thread
from rclpy.executors import SingleThreadedExecutor
another = rclpy.create_node("another")
another.create_timer(2.0, lambda: None)
executor = SingleThreadedExecutor()
executor.add_node(another)
Thread(target=executor.spin, daemon=True).start()
"""
SERVES = """
from std_srvs.srv import Empty
def serve(request, response):
    print("called at", node.get_clock().now().nanoseconds)
    return response
node.create_service(Empty, "/serve", serve)
"""
PLAN = Plan("simulated", Pose(5.5, 5.5, 0.0), None, 4.0)


def node(*timers: str, listens: str = "") -> str:
    """Return the source of a node with these lines in its constructor."""
    return NODE.format(timers="".join(f"        {line}\n" for line in timers), listens=listens)


def commands(recording: Recording) -> list[tuple[float, float, float]]:
    """Return the time of each command, the timer that sent it, and its count."""
    return [(each.t_s, each.linear[0], each.angular[2]) for each in recording.commands]


def heard(recording: Recording) -> int:
    """Return how many messages on /clock the node received, according to its last line."""
    return int(recording.stdout.text.split()[-1])


def said(recording: Recording) -> list[str]:
    """Return the log lines, each of which has the time on the node's clock."""
    return [line.text for line in recording.log if " at " in line.text]


def drawn_timers(seed: int) -> list[str]:
    """Return lines that create timers of random kinds, some of which cancel, change or create other timers."""
    draw = random.Random(seed)
    lines = []
    for which in range(draw.randint(1, 3)):
        period_s = draw.choice((0.005, 0.016, 0.02, 0.1, 0.25, 0.5, 1.0, 2.5)) * draw.choice((1.0, 1.0, 1.013))
        name = f"self.timer{which}"
        does = draw.choice(
            (
                f"self.send({which})",
                f"(self.send({which}), {name}.cancel() if self.count[{which}] == 3 else None)",
                f"(self.send({which}), setattr({name}, 'timer_period_ns', 10**8 * (1 + self.count[{which}] % 4)))",
                f"(self.send({which}), {name}.reset() if self.count[{which}] % 2 else None)",
                f"(self.send({which}), {name}.cancel(), self.create_timer(0.3, lambda: self.send({which + 10})))",
            )
        )
        lines.append(f"{name} = self.create_timer({period_s!r}, lambda: {does})")
    return lines


@in_a_cell
@pytest.mark.parametrize("seed", range(6))
def test_a_node_does_the_same_whether_it_gets_the_time_of_every_frame_or_not(seed: int) -> None:
    timers = drawn_timers(seed)
    with_pauses, every_frame = (run(node(*timers, listens=listens), PLAN) for listens in ("", LISTENS))
    assert commands(with_pauses)
    assert commands(with_pauses) == commands(every_frame)
    assert said(with_pauses) == said(every_frame)
    # The times are not compared: what is printed after Ctrl-C arrives when the processor has time.
    assert with_pauses.stdout.text == every_frame.stdout.text


@in_a_cell
@pytest.mark.parametrize(
    ("timers", "listens", "most", "least"),
    [
        (["self.create_timer(0.5, lambda: self.send(1))"], "", 60, 8),
        ([], "", 60, 8),
        (["self.create_timer(0.5, lambda: self.send(1))"], LISTENS, 300, 245),
        (["self.create_timer(0.5, lambda: self.send(1))"], 'node.create_client(SetPen, "/turtle1/set_pen")', 300, 245),
        (["self.create_timer(0.01, lambda: self.send(1))"], "", 300, 245),
        (["self.create_timer(0.5, lambda: self.send(1))"], ANOTHER, 300, 245),
    ],
    ids=["a timer", "no timer", "a subscription", "a client", "a timer that is due in each frame", "two executors"],
)
def test_a_node_gets_the_time_of_the_frames_in_which_it_may_act(
    timers: list[str], listens: str, most: int, least: int
) -> None:
    assert least <= heard(run(node(*timers, listens=listens + "\n" + COUNTS), PLAN)) <= most


FRAMES_NS = ((1_184_000_000, 1_200_000_000), (2_736_000_000, 2_752_000_000))


@in_a_cell
def test_a_node_that_is_called_by_the_trial_knows_the_time() -> None:
    calls = tuple(PlannedCall(at_s, "/serve", "std_srvs/srv/Empty", {}) for at_s in (1.2, 2.75))
    recording = run(node(listens=SERVES), replace(PLAN, inputs=Inputs(calls=calls)))
    # The time of the frame may arrive before or after the call that is made in this frame.
    known_ns = [int(line.split()[-1]) for line in recording.stdout.text.splitlines() if line.startswith("called")]
    assert [number in each for number, each in zip(known_ns, FRAMES_NS, strict=True)] == [True, True]


LIES = """
from rclpy.impl.implementation_singleton import rclpy_implementation
ours = rclpy_implementation.WaitSet
class Lies(ours.__base__):
    def wait(self, timeout_ns):
        pause[1] = 10**12
        super().wait(timeout_ns)
pause = next(cell.cell_contents for cell in ours.wait.__closure__ if hasattr(cell.cell_contents, "_length_"))
rclpy_implementation.WaitSet = Lies
"""


@in_a_cell
def test_a_node_that_claims_to_have_nothing_to_do_is_late() -> None:
    timer = "self.create_timer(0.1, lambda: self.send(1))"
    lies = run(node(timer, listens=LIES + COUNTS), PLAN)
    assert 8 <= heard(lies) <= 30
    assert len(commands(lies)) < len(commands(run(node(timer), PLAN))) / 2


MEMORY = """
import ctypes
pause = (ctypes.c_int64 * 2)({magic}, {ns})
print("ready", flush=True)
print(ctypes.addressof(pause), flush=True)
input()
"""


@pytest.mark.parametrize(
    ("magic", "ns", "pause_s"), [(PAUSES, 1_500_000_000, 1.5), (PAUSES, 0, 0.0), (PAUSES, -5, 0.0), (1, 10**9, 0.0)]
)
def test_a_pause_is_read_from_the_memory_of_the_launcher(magic: int, ns: int, pause_s: float) -> None:
    with python(MEMORY.format(magic=magic, ns=ns)) as process:
        assert process.stdout is not None
        assert process_pause_s(process.pid, int(process.stdout.readline())) == pause_s


def test_another_program_and_a_process_that_has_exited_have_no_pause() -> None:
    with python("print('ready', flush=True); input()") as process:
        assert process_pause_s(process.pid, 0) == 0.0
    assert process_pause_s(process.pid, 0) == 0.0
