from __future__ import annotations

import pytest

from grader.trial.clues import wall_clues

NODE = """
import rclpy
from rclpy.node import Node

class DrawCircle(Node):
    def __init__(self):
        super().__init__("draw_circle")
        self.timer = self.create_timer(0.5, self.send)
"""


def clues(source: str) -> list[str]:
    return [clue.name for clue in wall_clues({"pkg/node.py": source.encode()}, "pkg.node")]


def test_a_node_with_a_timer_gives_no_clue() -> None:
    assert clues(NODE) == []


@pytest.mark.parametrize(
    ("line", "name"),
    [
        ("import time\ntime.sleep(0.5)", "time.sleep"),
        ("from time import sleep as rest\nrest(0.5)", "time.sleep"),
        ("import time as t\nstart = t.time()", "time"),
        ("import threading\nthreading.Timer(0.5, print).start()", "threading"),
        ("from datetime import datetime\ndatetime.now()", "datetime.datetime"),
        ("rclpy.spin_once(node)", "rclpy.spin_once"),
        ("rclpy.spin_once(node, timeout_sec=0.5)", "timeout_sec"),
        ("node.get_clock().sleep_for(d)", "node.get_clock().sleep_for"),
        ("Clock(clock_type=ClockType.STEADY_TIME)", "ClockType.STEADY_TIME"),
        ("import asyncio\nasyncio.run(main())", "asyncio"),
        ("import threading\nlock = threading.Lock()\nthreading.Thread(target=f)", "threading"),
        ("node.get_logger().info('here', throttle_duration_sec=1.0)", "throttle_duration_sec"),
        ("Node('draw_circle', use_global_arguments=False)", "use_global_arguments"),
        ("now = rclpy.clock.Clock().now()", "a clock of its own"),
        ("Parameter('use_sim_time', value=False)", "use_sim_time"),
        ("rclpy.experimental.EventsExecutor().spin()", "EventsExecutor"),
        ("executor = EventsExecutor()", "EventsExecutor"),
        ("from select import select\nselect([], [], [], 0.5)", "select.select"),
        ("from timeit import default_timer as now\nstart = now()", "timeit.default_timer"),
    ],
)
def test_what_follows_wall_time_is_found(line: str, name: str) -> None:
    assert name in clues(NODE + line)


def test_a_module_that_is_imported_and_not_used_is_no_clue() -> None:
    assert clues("import time\n" + NODE) == []


@pytest.mark.parametrize(
    "source",
    [
        "import threading\nlock = threading.Lock()",
        "from threading import RLock as Guard\nguard = Guard()",
        "rclpy.init(args=args)",
        "rclpy.init(args=sys.argv)",
        "rclpy.init(args=['--ros-args'])",
        "rclpy.init([])",
        "self.init([1, 2])",
        "now = self.get_clock().now()",
    ],
)
def test_code_that_does_not_use_wall_time_is_not_a_clue(source: str) -> None:
    assert clues(NODE + source) == []


def test_only_what_the_node_reaches_counts() -> None:
    files = {
        "pkg/__init__.py": b"",
        "pkg/node.py": b"from pkg import helper\nfrom . import near\n",
        "pkg/helper.py": b"from .deep import x\n",
        "pkg/deep.py": b"import time\ntime.sleep(1)\n",
        "pkg/near.py": b"",
        "pkg/other.py": b"import time\ntime.sleep(2)\n",
        "setup.py": b"import time\ntime.sleep(3)\n",
    }
    assert [(clue.file, clue.line) for clue in wall_clues(files, "pkg.node")] == [("pkg/deep.py", 2)] * 2
    assert {clue.file for clue in wall_clues(files, None)} == {"pkg/deep.py", "pkg/other.py"}


def test_imports_are_followed_from_packages_in_packages() -> None:
    files = {
        "pkg/__init__.py": b"",
        "pkg/nodes/__init__.py": b"from .circle import main\n",
        "pkg/nodes/circle.py": b"from ..tools.clock import wait\n",
        "pkg/tools/clock.py": b"import time\ntime.sleep(1)\n",
    }
    assert {clue.file for clue in wall_clues(files, "pkg.nodes")} == {"pkg/tools/clock.py"}


def test_source_that_cannot_be_parsed_gives_no_clue() -> None:
    assert wall_clues({"pkg/node.py": b"import time\ntime.sleep(1\n", "pkg/null.py": b"\0"}, "pkg.node") == []
