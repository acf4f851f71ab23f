"""A student's tests cannot find out which node they run on, except by the behaviour of the node."""

from __future__ import annotations

import dataclasses
import io
import tarfile
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise
from grader.sandbox import bubblewrap
from grader.testbench import bench
from grader.testbench.bench import uses_one_participant
from grader.tests.testbench.bench_runs import STEP, TESTS, run, spec
from grader.tests.waiting import HANG_S, until_gone
from grader.trial import own_domain

if TYPE_CHECKING:
    from pathlib import Path

    from grader.testbench.result import NodeRun

pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")


def verdicts(runs: tuple[NodeRun, ...]) -> dict[str, bool]:
    return {each.node: each.accepted for each in runs}


def test_good_tests_accept_the_right_node_and_reject_the_others(files: dict[str, bytes]) -> None:
    runs = run(spec("stop", "type", right_runs=2), files, lanes=2)
    assert verdicts(runs) == {"": True, "stop": False, "type": False}
    rights = [(each.collected, each.passed) for each in runs if not each.node]
    assert len(rights) in (2, 3), "there is an additional run if a run on a broken node takes long"
    assert set(rights) == {(9, 9)}
    assert all(each.line > 0 for each in runs if each.node)


PEEKS = """
import hashlib, os, pathlib
from my_robot_controller import wall_guard

def everything():
    yield from (path.read_bytes() for path in sorted(pathlib.Path("/ws/src").rglob("*.py")))
    yield repr(sorted(os.environ.items())).encode()
    yield repr(sorted(vars(wall_guard))).encode()
    yield wall_guard.WallGuard.send.__code__.co_code

def test_it():
    assert hashlib.sha256(b"".join(everything())).hexdigest() == "?"
"""


def test_the_code_and_the_environment_are_the_same_for_all_nodes(
    files: dict[str, bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each run fails, with a digest of everything that the run can read. All these digests are equal."""
    nodes = spec("rate", "sign")
    # The correct node is not run, because its rejection would end the other runs. It would be run, too, if a run took
    # longer than this limit.
    monkeypatch.setattr(bench, "DOUBT_S", HANG_S)
    runs = run(dataclasses.replace(nodes, right_runs=0), {**files, TESTS: PEEKS.encode()})
    digests = {each.message.split("==")[0] for each in runs}
    assert (len(runs), len(digests)) == (2, 1), runs


LOOKS_FOR_THE_SESSION = """
import os, pathlib

def test_it():
    assert os.getppid() == 0
    others = [name for name in os.listdir("/proc") if name.isdigit() and int(name) != os.getpid()]
    assert {pathlib.Path("/proc", name, "comm").read_text() for name in others} == {"cat\\n"}
"""


def test_a_run_cannot_look_into_the_session(files: dict[str, bytes]) -> None:
    """The session is outside the cell."""
    runs = run(spec(), {**files, TESTS: LOOKS_FOR_THE_SESSION.encode()})
    assert [each.message for each in runs] == [""]


@pytest.mark.parametrize(
    "code",
    [
        "import os\nos._exit(0)\n",
        "import os\nopen('/ws/report.json', 'w').write('{\"collected\": 9, \"cases\": []}')\nos._exit(0)\n",
        "import os\nos.write(int(os.environ['GRADER_TESTBENCH'].split()[0]), b'x' * 27 * 100)\nos._exit(0)\n",
    ],
)
def test_a_forged_report_gets_the_same_verdict_on_every_node(code: str, files: dict[str, bytes]) -> None:
    runs = run(spec("rate", "stop"), {**files, TESTS: code.encode()})
    assert verdicts(runs) == {"": True, "rate": True, "stop": True}


KILLS = """
import os, signal
import rclpy
from my_robot_controller import wall_guard

rclpy.init()
wall_guard.WallGuard()
os.kill(-1, signal.SIGKILL)
"""


@pytest.mark.parametrize("code", [KILLS, "import os\nos.kill(os.getppid(), 9)\n"], ids=["all", "the parent"])
def test_tests_that_kill_the_processes_of_the_cell_are_rejected(files: dict[str, bytes], code: str) -> None:
    runs = run(spec("rate"), {**files, TESTS: code.encode()})
    assert not any(each.accepted for each in runs)


def test_a_rejected_right_node_ends_the_others(files: dict[str, bytes]) -> None:
    nodes = find_exercise(STEP).trials[0].tests
    assert nodes is not None
    runs = run(nodes, {**files, TESTS: b"def test_it():\n    assert False\n"})
    # If a run on a broken node takes long, there is an additional run on the correct node.
    assert sum(not each.node for each in runs) in (nodes.right_runs, nodes.right_runs + 1)
    assert len(runs) < nodes.right_runs + len(nodes.broken)


LISTENS = """
import rclpy
from rclpy.node import Node
from turtlesim.msg import Pose
from my_robot_controller.wall_guard import WallGuard

def test_it():
    rclpy.init()
    guard, sender = WallGuard(), Node("sender")
    sender.create_publisher(Pose, "/turtle1/pose", 10).publish(Pose(x=5.0, y=5.0))
    while guard.pose is None:  # on a busy machine, the timer may come first
        rclpy.spin_once(guard, timeout_sec=5.0)
    names = {name for name, _ in guard.get_node_names_and_namespaces()}
    rclpy.shutdown()
    assert names == {"wall_guard", "sender"}
    assert guard.pose.x == 5.0
"""


def test_without_a_cell_no_other_program_takes_part(files: dict[str, bytes]) -> None:
    runs = run(spec(right_runs=4), {**files, TESTS: LISTENS.encode()}, lanes=2, in_cell=False)
    assert [(each.exit_code, each.message) for each in runs] == [(0, "")] * 4


LEAVES_A_CHILD = """
import pathlib, subprocess

def test_it():
    child = subprocess.Popen(["sleep", "300"], start_new_session=True, stdout=subprocess.DEVNULL)
    pathlib.Path("{pid}").write_text(str(child.pid))
"""


def test_without_a_cell_a_child_in_a_session_of_its_own_ends_with_the_run(
    files: dict[str, bytes], tmp_path: Path
) -> None:
    pid = tmp_path / "pid"
    code = LEAVES_A_CHILD.replace("{pid}", str(pid))
    assert verdicts(run(spec(right_runs=1), {**files, TESTS: code.encode()}, in_cell=False)) == {"": True}
    until_gone(int(pid.read_text("ascii")))


TWO_CONTEXTS = """
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from turtlesim.msg import Pose
from my_robot_controller.wall_guard import WallGuard

def test_it():
    rclpy.init()
    other = Context()
    rclpy.init(context=other)
    guard, sender = WallGuard(), Node("sender", context=other)
    poses = sender.create_publisher(Pose, "/turtle1/pose", 10)
    while guard.pose is None:
        poses.publish(Pose(x=5.0, y=5.0))
        rclpy.spin_once(guard, timeout_sec=0.1)
    rclpy.shutdown()
"""


@pytest.mark.parametrize("in_cell", [True, False])
def test_nodes_in_two_contexts_discover_each_other(files: dict[str, bytes], in_cell: bool) -> None:
    (ended,) = run(spec(right_runs=1), {**files, TESTS: TWO_CONTEXTS.encode()}, in_cell=in_cell)
    assert (ended.exit_code, ended.message) == (0, "")


def test_without_a_cell_nodes_discover_each_other_if_all_lower_domains_are_in_use(
    files: dict[str, bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(own_domain, "_DOMAINS", range(215, 233))
    (ended,) = run(spec(right_runs=1), {**files, TESTS: TWO_CONTEXTS.encode()}, in_cell=False)
    assert (ended.exit_code, ended.message) == (0, "")


@pytest.mark.parametrize(
    ("code", "alone"),
    [
        ("import os\nfrom turtlesim.srv import Spawn\nself.spawn = rclpy.create_node('spawn')", True),
        ("from rclpy.context import Context", False),
        ("rclpy.Context()", False),
        ("import subprocess", False),
        ("os.posix_spawn('node', [], {})", False),
        ("os.fork()", False),
    ],
)
def test_more_contexts_and_processes_are_noticed(code: str, alone: bool) -> None:
    assert uses_one_participant({"setup.py": b"os.system('make')", "test/test_it.py": code.encode()}) is alone


@pytest.mark.parametrize(
    ("parameters", "takes"),
    [
        ("self", False),
        ("self, /", False),
        ("self, **options", True),
        ("self, name='wall_guard'", True),
        ("self, *, parameter_overrides=()", True),
    ],
)
def test_the_node_takes_options_only_if_the_students_own_node_takes_them(parameters: str, *, takes: bool) -> None:
    """Without options, a test that passes parameter_overrides fails in the student's workspace."""
    nodes = spec()
    source = f"class WallGuard(Node):\n    def __init__({parameters}):\n        pass\n"
    module = "my_robot_controller/wall_guard.py"
    packed = bench.pack(nodes, "my_robot_controller", {module: source.encode()})
    with tarfile.open(fileobj=io.BytesIO(packed)) as tree:
        given = tree.extractfile(f"my_robot_controller/{module}")
        assert given is not None
        assert given.read().decode().endswith("(RelayedNode):\n    pass\n") == takes
    assert bench.takes_options({}, module, "WallGuard")
