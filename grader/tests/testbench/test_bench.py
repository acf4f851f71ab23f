"""A student's tests cannot find out which node they run on, except by the behaviour of the node."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING

import pytest

from grader.checks.exercises import find_exercise
from grader.exercise.own_numbers import draw_numbers
from grader.ros import underlay
from grader.ros.installation import find_ros
from grader.sandbox import bubblewrap
from grader.submission.package import open_submission
from grader.testbench.bench import Bench
from grader.testbench.result import NodeRun, runs_of
from grader.tests.case import Case, make_submission

if TYPE_CHECKING:
    from pathlib import Path

    from grader.exercise.node_under_test import TestsSpec

STEP = "12-tests"
TESTS = "test/test_wall_guard.py"
HONEST = "def test_it():\n    assert True\n"
pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")


def spec(*broken: str, right_runs: int = 1, duration_s: float = 20.0) -> TestsSpec:
    """Return the settings of the course's tests with the solution's numbers, but with only these broken nodes."""
    exercise = find_exercise(STEP)
    whole = exercise.trials[0].tests
    assert whole is not None
    assert exercise.numbers is not None
    whole = whole.with_numbers(draw_numbers(exercise.numbers, "example").values)
    chosen = tuple(each for each in whole.broken if each.id in broken)
    return dataclasses.replace(whole, broken=chosen, right_runs=right_runs, duration_s=duration_s)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Return the files of the solution."""
    case = Case(name="solution", why="", result="passed", base=STEP)
    given: Path = make_submission(case, tmp_path_factory.mktemp("bench") / "in")
    return dict(open_submission(given).files)


def run(nodes: TestsSpec, files: dict[str, bytes], *, lanes: int = 1, in_cell: bool = True) -> tuple[NodeRun, ...]:
    ros = underlay.with_turtlesim(find_ros())
    bench = Bench(nodes, "wall_guard", "my_robot_controller", files, ros, in_cell=in_cell, lanes=lanes)
    bench.start()
    try:
        return runs_of(bench.result())
    finally:
        bench.close()


def verdicts(runs: tuple[NodeRun, ...]) -> dict[str, bool]:
    return {each.node: each.accepted for each in runs}


def test_good_tests_accept_the_right_node_and_reject_the_others(files: dict[str, bytes]) -> None:
    runs = run(spec("stop", "type", right_runs=2), files, lanes=2)
    assert verdicts(runs) == {"": True, "stop": False, "type": False}
    assert [(each.collected, each.passed) for each in runs if not each.node] == [(9, 9)] * 2
    assert all(each.line > 0 for each in runs if each.node)


LEAVES = """
import os, pathlib, subprocess, sys
found = [
    str(path) for top in ("/ws", "/tmp", "/dev/shm") for path in pathlib.Path(top).rglob("*") if "left" in path.name
]
others = [name for name in os.listdir("/proc") if name.isdigit() and int(name) not in (1, os.getpid(), os.getppid())]
commands = [open(f"/proc/{name}/cmdline").read() for name in others]
for top in ("/ws", "/tmp", "/dev/shm", "/ws/src", os.environ["HOME"]):
    pathlib.Path(top, "left").write_text("I was here")
closed = pathlib.Path("/ws/closed/left")
closed.mkdir(parents=True)
closed.parent.chmod(0)
pathlib.Path("/tmp/left-link").symlink_to("/")
subprocess.Popen([sys.executable, "-c", "import os, time; os.setsid(); time.sleep(600)"], start_new_session=True)

def test_nothing_is_left():
    assert (found, [each for each in commands if "setsid" in each]) == ([], [])
"""


def test_a_run_finds_nothing_of_an_earlier_one(files: dict[str, bytes]) -> None:
    runs = run(spec("rate", "topic", right_runs=3), {**files, TESTS: LEAVES.encode()})
    assert [(each.exit_code, each.message) for each in runs] == [(0, "")] * 5


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


def test_the_code_and_the_environment_are_the_same_for_all_nodes(files: dict[str, bytes]) -> None:
    """Each run fails, with a digest of everything that the run can read. All these digests are equal."""
    nodes = spec("rate", "sign")
    # The correct node is not run, because its rejection would end the other runs.
    runs = run(dataclasses.replace(nodes, right_runs=0), {**files, TESTS: PEEKS.encode()})
    digests = {each.message.split("==")[0] for each in runs}
    assert (len(runs), len(digests)) == (2, 1), runs


LOOKS_INTO_THE_SESSION = """
import os

def test_it():
    parent = os.getppid()
    for name in ("mem", "fd", "environ", "map_files"):
        path = f"/proc/{parent}/{name}"
        try:
            os.listdir(path) if name in ("fd", "map_files") else open(path, "rb").read(1)
        except (PermissionError, OSError):
            continue
        raise AssertionError(name)
"""


def test_a_run_cannot_look_into_the_session(files: dict[str, bytes]) -> None:
    runs = run(spec(), {**files, TESTS: LOOKS_INTO_THE_SESSION.encode()})
    assert [each.message for each in runs] == [""]


@pytest.mark.parametrize(
    "code",
    [
        "import os\nos._exit(0)\n",
        "import os\nopen('/ws/report.json', 'w').write('{\"collected\": 9, \"cases\": []}')\nos._exit(0)\n",
        "import os\nos.write(int(os.environ['GRADER_TESTBENCH'].split()[0]), b'x' * 27 * 100)\nos._exit(0)\n",
    ],
)
def test_a_lie_is_the_same_for_every_node(code: str, files: dict[str, bytes]) -> None:
    runs = run(spec("rate", "stop"), {**files, TESTS: code.encode()})
    assert verdicts(runs) == {"": True, "rate": True, "stop": True}


KILLS = """
import os, signal
import rclpy
from my_robot_controller import wall_guard

rclpy.init()
wall_guard.WallGuard()
os.kill(os.getppid(), signal.SIGKILL)
"""


@pytest.mark.parametrize("code", [KILLS, "import os\nos.kill(os.getppid(), 9)\n"], ids=["with a node", "at once"])
def test_who_kills_the_session_is_rejected(files: dict[str, bytes], code: str) -> None:
    runs = run(spec("rate"), {**files, TESTS: code.encode()})
    assert not any(each.accepted for each in runs)


def test_a_run_that_hangs_is_ended(files: dict[str, bytes]) -> None:
    code = b"import time\n\ndef test_it():\n    time.sleep(600)\n"
    runs = run(spec("rate", "stop", right_runs=3, duration_s=2.0), {**files, TESTS: code})
    assert [(each.over, each.accepted) for each in runs] == [(True, False)] * 2


def test_a_rejected_right_node_ends_the_others(files: dict[str, bytes]) -> None:
    nodes = find_exercise(STEP).trials[0].tests
    assert nodes is not None
    runs = run(nodes, {**files, TESTS: b"def test_it():\n    assert False\n"})
    assert sum(not each.node for each in runs) == nodes.right_runs


LISTENS = """
import rclpy
from rclpy.node import Node
from turtlesim.msg import Pose
from my_robot_controller.wall_guard import WallGuard

def test_it():
    rclpy.init()
    guard, sender = WallGuard(), Node("sender")
    sender.create_publisher(Pose, "/turtle1/pose", 10).publish(Pose(x=5.0, y=5.0))
    rclpy.spin_once(guard, timeout_sec=5.0)
    names = {name for name, _ in guard.get_node_names_and_namespaces()}
    rclpy.shutdown()
    assert names == {"wall_guard", "sender"}
    assert guard.pose.x == 5.0
"""


def test_without_a_cell_no_other_program_takes_part(files: dict[str, bytes]) -> None:
    runs = run(spec(right_runs=4), {**files, TESTS: LISTENS.encode()}, lanes=2, in_cell=False)
    assert [(each.exit_code, each.message) for each in runs] == [(0, "")] * 4
