"""The commands of lessons 08 to 13 that need a running node, typed in terminals like those of a reader.

Each terminal begins with the two lines that the lesson gives. A command that runs until Ctrl-C gets a terminal of its
own.
"""

from __future__ import annotations

import re
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pexpect
import pytest

from grader.authoring.console_blocks import blocks
from grader.tests.domains import own_domain
from grader.tests.learner.story import Learner
from grader.tests.test_lessons import ROOT, home_of_a_reader
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from collections.abc import Iterator

FIRST = "source ~/ros2-course/.venv/setup.bash; source ~/ros2_ws/install/setup.bash; cd ~/ros2_ws"
STEPS = ("08-services", "09-parameters", "10-actions", "11-bags", "12-tests", "13-catch-them-all")
SIM = "grader sim --view"


@dataclass(frozen=True)
class Typed:
    """A command, a regular expression for its output, whether it runs until Ctrl-C, and the commands to stop first."""

    command: str
    shows: str
    lasts: bool = False
    stop: tuple[str, ...] = ()


RUN = "ros2 run my_robot_controller"
TURN = "turtlesim/action/RotateAbsolute"
TYPED = {
    "08-services": (
        Typed("ros2 service list", "/turtle1/set_pen"),
        Typed("ros2 service type /turtle1/set_pen", "turtlesim/srv/SetPen"),
        Typed(
            'ros2 service call /turtle1/set_pen turtlesim/srv/SetPen "{r: 255, g: 220, b: 0, width: 4}"',
            r"SetPen_Response\(\)",
        ),
        Typed(
            'ros2 service call /spawn turtlesim/srv/Spawn "{x: 2.0, y: 9.0, theta: 0.0, name: painter}"',
            "name='painter'",
        ),
        Typed("cd ~/ros2_ws", ""),
        Typed("colcon build --symlink-install", "1 package finished"),
        Typed(f"{RUN} pausable_circle", "", lasts=True),
        Typed('ros2 service call /pause std_srvs/srv/SetBool "{data: true}"', "success=True"),
        Typed('ros2 service call /pause std_srvs/srv/SetBool "{data: false}"', "success=True"),
    ),
    "09-parameters": (
        Typed("ros2 param list", "background_r"),
        Typed("ros2 param get /turtlesim background_r", "Integer value is: 69"),
        Typed("ros2 param set /turtlesim background_r 150", "Set parameter successful"),
        Typed("ros2 param describe /turtlesim background_r", "(?s)Type: integer.*Max value: 255"),
        Typed("ros2 param set /turtlesim background_r 999", "Setting parameter failed: .*integer range"),
        Typed(f"{RUN} tunable_circle --ros-args -p radius:=2.0", "", lasts=True),
        Typed(
            f"{RUN} tunable_circle --ros-args --params-file slow.yaml",
            "",
            lasts=True,
            stop=(f"{RUN} tunable_circle --ros-args -p radius:=2.0",),
        ),
    ),
    "10-actions": (
        Typed("ros2 action list -t", rf"/turtle1/rotate_absolute \[{TURN}\]"),
        Typed(
            f'ros2 action send_goal /turtle1/rotate_absolute {TURN} "{{theta: 1.57}}"',
            "finished with status: SUCCEEDED",
        ),
        Typed(
            f'ros2 action send_goal --feedback /turtle1/rotate_absolute {TURN} "{{theta: 0.0}}"',
            "(?s)remaining:.*finished with status: SUCCEEDED",
        ),
        Typed(f"{RUN} lookout", r"-?\d\.\d\d rad to go", lasts=True),
        Typed("ros2 service call /stop std_srvs/srv/Trigger", "success=True"),
    ),
    "11-bags": (
        Typed(SIM, "", lasts=True),
        Typed("cd ~/ros2_ws/src/my_robot_controller", ""),
        Typed("ros2 bag record -o circle_bag --topics /turtle1/pose", "Recording", lasts=True),
        Typed(f"{RUN} tunable_circle --ros-args -p radius:=1.3 -p speed:=1.0", "", lasts=True),
        Typed(
            'ros2 topic pub -r 10 /turtle1/cmd_vel geometry_msgs/msg/Twist "{linear: {x: 1.0}, angular: {z: 0.769}}"',
            "publishing #3",
            lasts=True,
        ),
        Typed(
            "ros2 bag info circle_bag",
            r"(?s)Duration:.*Topic: /turtle1/pose \| Type: turtlesim/msg/Pose \| Count: \d\d",
            stop=("ros2 bag record", f"{RUN} tunable_circle", "ros2 topic pub", SIM),
        ),
        Typed("ros2 bag play circle_bag", ""),
    ),
    "12-tests": (
        Typed("colcon build --packages-select my_robot_controller", "1 package finished"),
        Typed("colcon test --packages-select my_robot_controller", "1 package finished"),
        Typed("colcon test-result --verbose", r"\d+ tests, 0 errors, 0 failures, 0 skipped"),
    ),
    "13-catch-them-all": (
        Typed("ros2 interface show turtlesim/srv/Kill", "(?s)string name.*---"),
        Typed(f"{RUN} spawner", "", lasts=True),
        Typed("ros2 topic echo /targets", "data: target1 target2", lasts=True),
        Typed(
            'ros2 service call /catch turtlesim/srv/Kill "{name: target2}"', r"Kill_Response\(\)", stop=("ros2 topic",)
        ),
        Typed(
            'ros2 service call /spawn turtlesim/srv/Spawn "{x: 2.0, y: 8.0, name: berta}"',
            "name='berta'",
            stop=(f"{RUN} spawner",),
        ),
        Typed('ros2 topic pub /targets std_msgs/msg/String "{data: berta}"', "publishing #1", lasts=True),
        Typed(f"{RUN} catcher", "", lasts=True),
    ),
}
"""All commands of the lessons' blocks for running nodes, in the lessons' order."""
ALSO = {
    "08-services": (
        Typed('ros2 service call /spawn turtlesim/srv/Spawn "{x: 2.0, y: 9.0, name: painter}"', "name=''"),
    ),
    "13-catch-them-all": (
        Typed("until ros2 topic echo --once /turtle1/pose | grep -E '^x: (1|2)[.]'; do :; done", "x: "),
    ),
}
"""More commands at the end of a lesson, which show what its text says: an empty name; the turtle drives to berta."""


def lesson_text(step: str) -> str:
    return (ROOT / "course" / step / "lesson.md").read_text("utf-8")


@pytest.mark.parametrize("step", STEPS)
def test_every_command_of_a_running_block_is_typed(step: str) -> None:
    shown = [
        command.command
        for block in blocks(lesson_text(step))
        if (block.language, block.about) == ("console", "running")
        for command in block.steps()
    ]
    assert [typed.command for typed in TYPED[step]] == shown


class Terminals:
    """One terminal for short commands, and one for each command that runs until Ctrl-C."""

    def __init__(self, env: dict[str, str], folder: Path) -> None:
        self.env, self.folder = env, folder
        self.lasting: dict[str, pexpect.spawn[str]] = {}
        self.place = "~/ros2_ws"
        self.hand = self.opened()

    def opened(self) -> pexpect.spawn[str]:
        shell = pexpect.spawn(
            "bash",
            ["--norc", "--noprofile"],
            env=self.env,
            cwd=self.folder,
            encoding="utf-8",
            timeout=HANG_S,
            echo=False,
            dimensions=(50, 200),
        )
        self.enter(shell, f"{FIRST}; cd {self.place}")
        return shell

    def enter(self, shell: pexpect.spawn[str], command: str) -> str:
        """Type a command, wait for its end, and return its output."""
        shell.sendline(f"{command}; echo done''with")
        shell.expect_exact("donewith")
        return shell.before or ""

    def type(self, typed: Typed) -> None:
        for command in [each for each in self.lasting if each.startswith(typed.stop)] if typed.stop else ():
            self.end(command)
        if typed.lasts:
            shell = self.lasting[typed.command] = self.opened()
            shell.sendline(typed.command)
            shell.expect(typed.shows)
        else:
            said = self.enter(self.hand, typed.command)
            assert re.search(typed.shows, said), f"{typed.command}\n{said}"
            if typed.command.startswith("cd "):
                self.place = typed.command.removeprefix("cd ")

    def end(self, command: str) -> None:
        """Press Ctrl-C, and wait until the command has ended."""
        shell = self.lasting.pop(command)
        shell.sendintr()
        self.enter(shell, ":")
        shell.close()


@pytest.fixture(scope="module")
def home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A home folder with a workspace in which steps 08 to 13 are started."""
    folder = tmp_path_factory.mktemp("reader")
    home_of_a_reader(folder)
    reader = Learner(folder / "home")
    for step in STEPS:
        reader.reads("start", step)
    return folder


@pytest.fixture
def terminals(home: Path, tmp_path: Path) -> Iterator[Terminals]:
    env = {**Learner(home / "home").env, "PS1": "", "TERM": "dumb", "ROS_DOMAIN_ID": str(own_domain())}
    env["PATH"] = f"{Path(sys.executable).parent}:{env['PATH']}"
    opened = Terminals(env, tmp_path)
    yield opened
    for command in list(opened.lasting)[::-1]:
        opened.end(command)
    opened.hand.close()


@pytest.mark.exhaustive
@pytest.mark.parametrize("step", STEPS)
def test_the_commands_of_a_running_block_do_what_the_lesson_says(step: str, terminals: Terminals, home: Path) -> None:
    workspace = home / "home/ros2_ws"
    Learner(home / "home").solves(step)
    if step == "09-parameters":
        (file,) = re.findall(r"^    /\*\*:\n(?:    .*\n)+", lesson_text(step), re.MULTILINE)
        (workspace / "slow.yaml").write_text(re.sub(r"^    ", "", file, flags=re.MULTILINE))
    if step == "11-bags":
        shutil.rmtree(workspace / "src/my_robot_controller/circle_bag")
    elif step != "12-tests":
        terminals.type(Typed(SIM, "", lasts=True))
    terminals.enter(terminals.hand, "colcon build --symlink-install; source install/setup.bash")
    for typed in (*TYPED[step], *ALSO.get(step, ())):
        terminals.type(typed)
