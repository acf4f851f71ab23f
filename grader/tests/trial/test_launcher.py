from __future__ import annotations

import io
import json
import os
import signal
import socket
import subprocess
import tarfile
from typing import TYPE_CHECKING

import pytest

import grader.trial
from grader.sandbox import bubblewrap
from grader.sandbox.limits import NODE_LIMITS
from grader.tests.waiting import HANG_S
from grader.trial import launchers

if TYPE_CHECKING:
    from pathlib import Path

    from grader.tests.in_ros import InRos

SCRIPT = """#!/usr/bin/env python3
import signal
print(signal.getsignal(signal.SIGINT) is signal.default_int_handler, signal.pthread_sigmask(signal.SIG_BLOCK, ()))
"""


def deaf_to_ctrl_c() -> None:
    """Ignore Ctrl-C, as in a job that a shell starts in the background."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})


ARGUMENTS = """#!/usr/bin/env python3
import sys
import rclpy
rclpy.init(args={args})
print(rclpy.create_node("fish").get_parameter("use_sim_time").value, len(sys.argv))
"""
SIMULATED = ["--ros-args", "-p", "use_sim_time:=true"]


def launch(in_ros: InRos, folder: Path, text: str, ros_arguments: list[str]) -> subprocess.CompletedProcess[bytes]:
    """Run a program with the launcher."""
    script = folder / "node"
    script.write_text(text, "utf-8")
    tree = io.BytesIO()
    tarfile.open(fileobj=tree, mode="w").close()
    given = {"script": str(script), "ros_arguments": ros_arguments}
    order = {**given, "python_path": [], "env": {}, "install": str(folder / "install")}
    return subprocess.run(
        [in_ros.ros.python, f"{grader.trial.__path__[0]}/launcher.py"],
        input=json.dumps(order).encode() + b"\n" + tree.getvalue(),
        env=in_ros.environment(),
        capture_output=True,
        preexec_fn=deaf_to_ctrl_c,
        timeout=HANG_S,
        check=False,
    )


class NoCell:
    """Replaces Holder, and creates no cell."""

    def __init__(self, *_: object) -> None:
        pass

    def await_ready(self) -> int:
        return os.open(os.devnull, os.O_RDONLY)

    def close(self) -> None:
        pass


def test_the_error_says_that_no_process_is_left_that_forks_nodes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(launchers, "Holder", NoCell)
    nodes, fork_server = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    fork_server.close()
    with nodes, pytest.raises(launchers.LaunchError, match="the process of the grader that forks nodes has exited"):
        launchers.LauncherInCell(bubblewrap.View(()), NODE_LIMITS, nodes)


def printed(done: subprocess.CompletedProcess[bytes]) -> bytes:
    """Return the output of the program itself."""
    return done.stdout.partition(b"ready ")[2].partition(b"\n")[2]


def test_a_node_hears_ctrl_c_though_its_grader_does_not(in_ros: InRos, tmp_path: Path) -> None:
    done = launch(in_ros, tmp_path, SCRIPT, [])
    assert printed(done) == b"True set()\n", done.stderr


ENDS = """#!/usr/bin/env python3
import atexit, ctypes, sys
import rclpy
libc = ctypes.CDLL(None)
libc.on_exit(libc.abort, None)  # the cleanup of a library
atexit.register(print, "cleaned up")
rclpy.init()
{end}
libc.printf(b"from C\\n")
sys.exit(3)
"""


def test_a_node_that_has_shut_down_exits_without_the_cleanup_of_its_libraries(in_ros: InRos, tmp_path: Path) -> None:
    done = launch(in_ros, tmp_path, ENDS.format(end="rclpy.shutdown()"), [])
    assert done.returncode == 3, done.stderr
    assert sorted(printed(done).splitlines()) == [b"cleaned up", b"from C"]


def test_any_other_node_exits_as_always(in_ros: InRos, tmp_path: Path) -> None:
    done = launch(in_ros, tmp_path, ENDS.format(end=""), [])
    assert done.returncode == -signal.SIGABRT, done.stderr


LAST = """#!/usr/bin/env python3
import rclpy
from rclpy.publisher import Publisher
from std_msgs.msg import String
acknowledged = iter({answers})
Publisher.wait_for_all_acked = lambda *_: next(acknowledged)
rclpy.init()
node = rclpy.create_node("fish")
node.destroy_publisher(node.create_publisher(String, "words", 10))
print(next(acknowledged))
"""


def test_a_publisher_is_destroyed_after_its_messages_have_been_acknowledged(in_ros: InRos, tmp_path: Path) -> None:
    done = launch(in_ros, tmp_path, LAST.format(answers=[False, False, True, "destroyed"]), [])
    assert printed(done) == b"destroyed\n", done.stderr


def test_a_crash_is_not_delayed_by_messages_that_are_not_acknowledged(in_ros: InRos, tmp_path: Path) -> None:
    crash = "try:\n    1 / 0\nfinally:\n    node.destroy_publisher("
    script = LAST.format(answers=[False, "destroyed at once", True]).replace("node.destroy_publisher(", crash)
    script = script.replace("\nprint(", "\n    print(")
    done = launch(in_ros, tmp_path, script, [])
    assert printed(done) == b"destroyed at once\n", done.stderr


def test_a_publisher_is_destroyed_even_if_its_messages_are_never_acknowledged(in_ros: InRos, tmp_path: Path) -> None:
    done = launch(in_ros, tmp_path, LAST.format(answers="lambda: False, True") + "print('destroyed')\n", [])
    assert printed(done) == b"False\ndestroyed\n", done.stderr


@pytest.mark.parametrize("args", ["None", "sys.argv", "[]", "('node', '--ros-args', '-r', 'a:=b', '--')"])
def test_simulated_time_is_requested_without_an_argument_that_the_program_sees(
    in_ros: InRos, tmp_path: Path, args: str
) -> None:
    done = launch(in_ros, tmp_path, ARGUMENTS.format(args=args), SIMULATED)
    assert printed(done) == b"True 1\n", done.stderr


def test_a_traceback_shows_the_program_alone(in_ros: InRos, tmp_path: Path) -> None:
    twice = "#!/usr/bin/env python3\nimport rclpy\nrclpy.init()\nrclpy.init()\n"
    done = launch(in_ros, tmp_path, twice, SIMULATED)
    assert b"Context.init() must only be called once" in done.stderr
    assert b"launcher.py" not in done.stderr
    assert b'node", line 4, in <module>' in done.stderr


ARRAYS = """#!/usr/bin/env python3
import sys
loaded = [name in sys.modules for name in ("numpy", "yaml")]
from geometry_msgs.msg import PoseWithCovariance, Twist
Twist()
loaded.append("numpy" in sys.modules)
covariance = PoseWithCovariance().covariance
import numpy
import yaml
print(loaded, type(covariance) is numpy.ndarray, numpy.zeros(2).sum(), yaml.safe_load("1"), type(numpy).__name__)
"""


@pytest.mark.parametrize(
    ("arguments", "loaded"),
    [(SIMULATED, False), ([], True), (["--ros-args", "-p", "radius:=1.0"], True)],
    ids=["simulated", "wall", "wall with a parameter"],
)
def test_modules_that_few_nodes_need_are_imported_on_first_use(
    in_ros: InRos, tmp_path: Path, arguments: list[str], *, loaded: bool
) -> None:
    """In wall time, they are imported before the program runs, since the import would delay a callback."""
    done = launch(in_ros, tmp_path, ARRAYS, arguments)
    assert printed(done).decode() == f"{[loaded] * 3} True 0.0 1 module\n", done.stderr


INTERFACES = """#!/usr/bin/env python3
import sys
loaded = ["rosidl_generator_py" in sys.modules, "lark" in sys.modules]
from nav_msgs.msg import Odometry
type(Odometry).__import_type_support__()
import rosidl_generator_py.generate_py_impl
print(loaded, Odometry._TYPE_SUPPORT is not None, "lark" in sys.modules)
"""


def test_the_generator_of_interfaces_is_imported_only_by_a_program_that_needs_it(in_ros: InRos, tmp_path: Path) -> None:
    done = launch(in_ros, tmp_path, INTERFACES, SIMULATED)
    assert printed(done).decode() == "[True, False] True True\n", done.stderr
