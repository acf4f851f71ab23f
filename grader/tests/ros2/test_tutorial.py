"""The commands of the tutorial, typed into a real shell, with an empty home folder and only the wheels."""

from __future__ import annotations

import os
import re
import shutil
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import pexpect
import pytest

from grader.ros import installation
from grader.tests.both_worlds import of_the_wheels
from grader.tests.domains import own_domain
from grader.tests.ros2.world import SOLUTION, golden
from grader.tests.waiting import HANG_S, until_gone

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = of_the_wheels
PROMPT = "next> "
BIN = Path(sys.executable).parent


class Terminal:
    """A bash shell on a terminal, in the state in which `source .venv/bin/activate` leaves it."""

    def __init__(self, home: Path, domain: int) -> None:
        cache = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
        env = {"HOME": str(home), "PATH": f"{BIN}:/usr/bin:/bin", "LANG": "C.UTF-8", "TERM": "dumb", "LOGNAME": "root"}
        # Share the cache, so that an empty home folder does not cause another build of the interfaces.
        env |= {"XDG_CACHE_HOME": cache, "ROS_DOMAIN_ID": str(domain), "PS1": PROMPT, "GRADER_ROS2_DAEMON": "0"}
        self.shell = pexpect.spawn(
            "/bin/bash",
            ["--norc", "--noprofile", "--noediting", "-i"],
            env=env,
            cwd=str(home),
            echo=False,
            encoding="utf-8",
            timeout=HANG_S,
        )
        self.shell.setwinsize(50, 200)
        self.shell.expect_exact(PROMPT)

    def type(self, command: str) -> str:
        """Type a command, wait until it has ended, and return its output."""
        self.shell.sendline(command)
        self.shell.expect_exact(PROMPT)
        return (self.shell.before or "").replace("\r\n", "\n")

    def code(self) -> int:
        """Return the exit code of the last command."""
        return int(self.type("echo $?"))

    def begin(self, command: str, ready: str) -> None:
        """Type a command that does not end, and wait for a part of its output."""
        self.shell.sendline(command)
        self.shell.expect_exact(ready)

    def ctrl_c(self) -> str:
        """Press Ctrl-C and wait for the prompt. Return the output before the prompt."""
        self.shell.sendintr()
        self.shell.expect_exact(PROMPT)
        return (self.shell.before or "").replace("\r\n", "\n")

    def close(self) -> None:
        """Close the terminal as if the connection were lost."""
        with suppress(pexpect.ExceptionPexpect):
            self.shell.close(force=True)


@pytest.fixture
def domain() -> int:
    return own_domain()


@pytest.fixture
def home(tmp_path: Path) -> Path:
    folder = tmp_path / "student"
    folder.mkdir()
    (folder / ".gitconfig").write_text("[user]\nemail = student@example.com\n")
    return folder


@pytest.fixture
def terminals(home: Path, domain: int) -> Iterator[list[Terminal]]:
    """Open three terminals, as on a learner's screen."""
    opened = [Terminal(home, domain) for _ in range(3)]
    yield opened
    for terminal in opened:
        terminal.close()


def test_the_whole_path(home: Path, terminals: list[Terminal]) -> None:
    turtle, node, look = terminals

    def typed(name: str) -> None:
        expected = golden(name)
        assert look.type(expected.command) == expected.stdout + expected.stderr
        assert look.code() == expected.code

    for terminal in terminals:
        assert terminal.type("source <(grader env)") == ""
    typed("topic_list_nothing_running")

    turtle.begin("ros2 run turtlesim turtlesim_node", "Spawning turtle [turtle1]")
    typed("topic_list_turtlesim_only")
    typed("topic_info_cmd_vel_before")
    assert "Vector3  linear\n\tfloat64 x\n" in look.type("ros2 interface show geometry_msgs/msg/Twist")
    typed("interface_show_twist_no_comments")

    node.type("mkdir -p ~/ros2_ws/src && cd ~/ros2_ws/src")
    create = "ros2 pkg create --build-type ament_python my_robot_controller --dependencies rclpy"
    made = node.type(create)
    assert made == golden("pkg_create_ament_python").stdout.replace("/home/student", str(home))
    assert node.code() == 0
    package = home / "ros2_ws/src/my_robot_controller"
    # This is the code from the tutorial.
    shutil.copy(SOLUTION / "my_robot_controller/draw_circle.py", package / "my_robot_controller/draw_circle.py")
    manifest, setup = package / "package.xml", package / "setup.py"
    depends = "<depend>rclpy</depend>\n  <depend>geometry_msgs</depend>\n  <depend>turtlesim</depend>"
    manifest.write_text(manifest.read_text().replace("<depend>rclpy</depend>", depends))
    entry = "'console_scripts': [\n            'draw_circle = my_robot_controller.draw_circle:main',"
    setup.write_text(setup.read_text().replace("'console_scripts': [", entry))

    node.type("cd ~/ros2_ws")
    built = node.type("colcon build --symlink-install")
    assert "1 package finished" in built
    assert "WARNING" not in built
    assert node.code() == 0
    assert node.type("source install/setup.bash") == ""
    node.begin("ros2 run my_robot_controller draw_circle", "Draw circle node has been started")

    typed("node_list")
    typed("topic_info_cmd_vel")
    typed("node_info_draw_circle")
    expected = golden("topic_echo_cmd_vel")
    look.begin(expected.command, "---")
    assert re.fullmatch(r"(\^C)?\n?", look.ctrl_c().replace("---\n", "").partition("linear:")[0])
    assert look.code() == expected.code
    look.begin(golden("topic_hz_cmd_vel").command, "average rate: ")
    look.ctrl_c()
    assert look.code() == 2
    assert "Traceback" not in node.ctrl_c()
    assert node.code() == 0
    typed("node_list_turtlesim_only")
    assert "Traceback" not in turtle.ctrl_c()
    assert turtle.code() == 0
    typed("topic_list_nothing_running")
    assert not (home / ".ros").exists() or not list((home / ".ros/log").glob("ros2_*"))


def test_a_workspace_alone_brings_ros_2_with_it(home: Path, terminals: list[Terminal]) -> None:
    first, second, _ = terminals
    first.type("source <(grader env) && mkdir -p ~/ros2_ws/src && cd ~/ros2_ws/src")
    first.type("ros2 pkg create --build-type ament_python --node-name my_node my_package && cd ..")
    assert "1 package finished" in first.type("colcon build")
    # In a new terminal, a tutorial requires only this command.
    second.type("cd ~/ros2_ws && source install/setup.bash")
    assert second.type("ros2 run my_package my_node") == "Hi from my_package.\n"
    assert second.type("ros2 pkg prefix my_package") == f"{home}/ros2_ws/install/my_package\n"
    assert "turtlesim turtlesim_node" in second.type("ros2 pkg executables turtlesim")


def test_ros2_works_in_a_shell_that_nobody_prepared(terminals: list[Terminal]) -> None:
    assert terminals[0].type("ros2 topic list") == golden("topic_list_nothing_running").stdout
    assert terminals[0].type("ros2 interface show turtlesim/msg/Color") == golden("interface_show_color").stdout


def test_a_turtlesim_without_a_window_says_where_to_look(terminals: list[Terminal]) -> None:
    terminals[0].begin("grader sim", "or --view terminal.")
    assert "Traceback" not in terminals[0].ctrl_c()


def test_grader_shell(terminals: list[Terminal]) -> None:
    terminal = terminals[0]
    terminal.begin("SHELL=/bin/bash grader shell --domain 57", "in ROS domain 57")
    terminal.shell.sendline(f"PS1='{PROMPT}'; echo sees $ROS_DISTRO $ROS_DOMAIN_ID")
    terminal.shell.expect_exact("sees jazzy 57")
    terminal.shell.expect_exact(PROMPT)
    assert "turtlesim" in terminal.type("ros2 pkg list").split()
    assert terminal.type("complete -p ros2").rstrip().endswith("ros2")
    terminal.shell.sendline("exit")
    terminal.shell.expect_exact(PROMPT)
    assert terminal.type("echo $ROS_DISTRO") == "\n"


def process_ids(domain: int) -> set[str]:
    """Return the ids of the running processes in this domain."""
    found = set()
    for folder in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            if f"ROS_DOMAIN_ID={domain}\0".encode() in (folder / "environ").read_bytes():
                found.add(folder.name)
    return found


def test_a_lost_terminal_leaves_no_process_behind(terminals: list[Terminal], domain: int) -> None:
    turtle, echo, pub = terminals
    for terminal in terminals:
        terminal.type("source <(grader env)")
    turtle.begin("ros2 run turtlesim turtlesim_node", "Spawning")
    echo.begin("ros2 topic echo /turtle1/pose", "---")
    pub.begin("ros2 topic pub /turtle1/cmd_vel geometry_msgs/msg/Twist", "publishing #1")
    there = process_ids(domain)
    assert len(there) >= 6  # the three shells and the programs that they have started
    for terminal in terminals:
        # `close` would kill the processes. pexpect must not close the descriptor a second time, when it may be in use.
        terminal.shell.ptyproc.fileobj.close()
        terminal.shell.ptyproc.closed = terminal.shell.closed = True
    for pid in there:
        until_gone(int(pid))
    for terminal in terminals:
        with suppress(ChildProcessError):
            os.waitpid(terminal.shell.pid, 0)
    terminals.clear()
    assert not process_ids(domain)


def test_a_command_that_cannot_leave_the_graph_is_ended() -> None:
    swallows = (
        "import signal, time\n"
        "from grader.ros2 import main\n"
        "main.ENDS_S = 1\n"
        "signal.signal(signal.SIGHUP, main._end)\n"
        "while True:\n"
        "    try:\n"
        "        print('ready', flush=True)\n"
        "        time.sleep(60)\n"
        "    except BaseException:\n"
        "        pass\n"
    )
    with subprocess.Popen([sys.executable, "-c", swallows], stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        process.send_signal(signal.SIGHUP)
        assert process.wait(HANG_S) == -signal.SIGALRM


def test_users_of_one_machine_have_domains_of_their_own() -> None:
    ordinary = [installation.domain_of(uid) for uid in range(1000, 1100)]
    assert len(set(ordinary)) == len(ordinary)
    assert all(1 <= domain <= 101 for domain in [*ordinary, installation.domain_of(0), installation.domain_of(65534)])
