"""A node that is started in the page can reach the live turtle, but nothing else outside of its sandbox cell."""

from __future__ import annotations

import asyncio
import json
import os
import re
import signal
import socket
import subprocess
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from selectors import DefaultSelector
from typing import TYPE_CHECKING, Literal

import pytest

from grader.common.interpreter import interpreter
from grader.errors import MachineError
from grader.open import programs
from grader.open.dds_ports import FIRST_OWN, OTHERS, participant_ports
from grader.open.linked_cell import LinkedCell, linkable
from grader.ros import installation
from grader.sandbox import bubblewrap
from grader.tests.both_worlds import HERE
from grader.tests.domains import own_domain
from grader.tests.open.course import CIRCLE, Course
from grader.tests.ros2.world import environment
from grader.tests.waiting import HANG_S, until, until_gone
from grader.view.address import Address

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from grader.common.interpreter import Start

HOSTILE = Path(__file__).with_name("hostile_node.py")
SENT = b"hostile"
"""The datagram of the attack."""
ANSWERING = HOSTILE.with_name("answering_nodes.py")
ASKING = HOSTILE.with_name("asking_node.py")
SETTINGS = json.dumps({"step": CIRCLE, "executable": "draw_circle", "workspace": None})
needs_cells = pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")


@pytest.fixture(scope="module")
def learner(tmp_path_factory: pytest.TempPathFactory) -> Course:
    """Create a learner who has started step 03, without a server."""
    made = Course(tmp_path_factory.mktemp("learner"))
    made.run("start", CIRCLE)
    return made


@contextmanager
def running(start: Start, learner: Course, domain: int) -> Iterator[subprocess.Popen[str]]:
    """Start a program as the page does. At the end, kill the program's process group."""
    process = subprocess.Popen(
        start.argv,
        env={**start.env, "ROS_DOMAIN_ID": str(domain), "PYTHONUNBUFFERED": "1"},
        cwd=learner.home,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        start_new_session=True,
    )
    with process:
        try:
            yield process
        finally:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)


def in_cell(learner: Course) -> Start:
    return interpreter("-m", "grader.open.node_in_cell", SETTINGS, env=learner.env, searches=True)


@dataclass(frozen=True)
class Machine:
    """The targets of an attack on this machine: a secret, and ports with listening sockets."""

    home: Path
    tcp: socket.socket
    udp: list[socket.socket]

    def reached(self) -> list[str]:
        """The effects of an attack outside its cell."""
        found = [path.parent.name for path in (self.home / "written", self.home / "ros2_ws/written") if path.exists()]
        for listening in (self.tcp, *self.udp):
            listening.settimeout(0)
            try:
                # Nodes of other tests may send to the same ports.
                if listening is self.tcp:
                    _ = listening.accept()
                    found.append(str(listening.type.name))
                while listening is not self.tcp:
                    if listening.recv(100) == SENT:
                        found.append(str(listening.type.name))
            except BlockingIOError:
                continue
        return found


@contextmanager
def machine(learner: Course, domain: int) -> Iterator[Machine]:
    (learner.home / ".secret").write_text("a secret of the learner")
    others = (participant_ports(other, 0)[0] for other in range(domain + 1, domain + 50))
    with socket.create_server(("127.0.0.1", 0)) as tcp:
        udp = [bound([0]), bound(others), bound(range(FIRST_OWN + 20, FIRST_OWN + OTHERS))]
        yield Machine(learner.home, tcp, udp)
        for each in udp:
            each.close()


def bound(ports: Iterable[int]) -> socket.socket:
    """Return a socket that is bound to the first of these ports that no other program uses."""
    listening = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    for port in ports:
        with suppress(OSError):
            listening.bind(("127.0.0.1", port))
            return listening
    raise AssertionError("all of these ports are in use")  # noqa: EM101


def hostile(learner: Course, found: Machine, name: str) -> None:
    """Replace the learner's node with the attack."""
    words = {
        "HOME": str(learner.home),
        "WORKSPACE": str(learner.workspace),
        "TCP_PORT": str(found.tcp.getsockname()[1]),
        "UDP_PORTS": ",".join(str(each.getsockname()[1]) for each in found.udp),
        "LEFT_BEHIND": name,
    }
    learner.node.write_text(re.sub("|".join(words), lambda match: words[match[0]], HOSTILE.read_text()))


def left_behind(name: str) -> list[int]:
    """Return the processes of this machine with this name as their first argument."""
    found = []
    for place in Path("/proc").glob("[0-9]*"):
        try:
            arguments = (place / "cmdline").read_bytes().split(b"\0")
        except OSError:
            continue
        if arguments[0].decode("utf-8", "replace") == name:
            found.append(int(place.name))
    return found


@pytest.mark.parametrize("defended", [pytest.param(True, marks=needs_cells), False], ids=["in a cell", "as the user"])
def test_an_attack_reaches_nothing_and_leaves_nothing(learner: Course, *, defended: bool) -> None:
    domain = own_domain()
    name = f"hostile-{os.getpid()}-{defended}"
    with machine(learner, domain) as found:
        hostile(learner, found, name)
        start = in_cell(learner) if defended else interpreter(str(learner.node), env=learner.env)
        with running(start, learner, domain) as process:
            assert process.stdin is not None
            assert process.stdout is not None
            output = ""
            while "all was tried" not in output:
                line = process.stdout.readline()
                assert line, output
                output += line
            until(lambda: bool(left_behind(name)))
            left = left_behind(name)
            # Kill the page's process.
            process.stdin.close()
            if defended:
                assert process.wait(HANG_S) == 0
                for pid in left:
                    until_gone(pid)
                assert "a secret" not in output
                assert found.reached() == []
            else:
                # The attack is real.
                assert "a secret" in output
                assert found.reached() == [learner.home.name, "ros2_ws", "SOCK_STREAM", *["SOCK_DGRAM"] * 3]
                os.killpg(left[0], signal.SIGKILL)  # the shell and its child


@needs_cells
def test_each_context_and_each_child_process_of_a_program_can_be_reached(learner: Course) -> None:
    learner.node.write_text(ANSWERING.read_text())
    domain = own_domain()
    outside = interpreter(str(ASKING), env=environment(learner.home, domain), searches=True)
    with running(in_cell(learner), learner, domain) as process, running(outside, learner, domain) as asking:
        assert asking.stdout is not None
        assert process.stdin is not None
        names, _ = asking.communicate(timeout=HANG_S)
        assert sorted(names.split()) == ["child", "first", "second"]
        process.stdin.close()
        assert process.wait(HANG_S) == 0


@needs_cells
def test_an_error_names_the_learners_own_file(learner: Course) -> None:
    learner.save("rclpy.init(args=args)", "raise RuntimeError('too bad')")
    with running(in_cell(learner), learner, own_domain()) as process:
        assert process.stdout is not None
        output = process.stdout.read()
        assert process.wait(HANG_S) == 1
    assert f'File "{learner.node}", line ' in output
    assert "draw_circle ended with exit code 1." in output


@needs_cells
def test_a_package_that_cannot_be_built_says_why(learner: Course) -> None:
    setup = learner.node.parent.parent / "setup.py"
    before = setup.read_text()
    setup.write_text("raise ValueError('no setup today')\n")
    with running(in_cell(learner), learner, own_domain()) as process:
        assert process.stdout is not None
        output = process.stdout.read()
        assert process.wait(HANG_S) == 1
    setup.write_text(before)
    assert "no setup today" in output
    assert "The package could not be built. See the messages of colcon above." in output


def test_without_a_sandbox_the_page_says_that_the_node_runs_as_the_user(monkeypatch: pytest.MonkeyPatch) -> None:
    started: list[tuple[str, ...]] = []

    async def start(program: programs.Program, *arguments: str, says: str = "", held: bool = False) -> None:
        started.append((*arguments, says))
        assert not held
        program.lines.append("Spawning turtle")

    monkeypatch.setattr(programs.Program, "start", start)
    monkeypatch.setattr(programs.Program, "running", True)
    monkeypatch.setattr(programs, "linkable", lambda: False)
    monkeypatch.setattr(programs, "_turtle_is_there", lambda: False)
    asyncio.run(programs.Programs(lambda: None, None).start_node(CIRCLE, "draw_circle", ""))
    assert started[-1] == ("-m", "grader.cli", "run", "--no-view", CIRCLE, "draw_circle", programs.NO_CELL)
    assert "under your account" in programs.NO_CELL


@pytest.mark.parametrize(("kind", "linked"), [("sourced", False), ("wheels", True)])
def test_another_middleware_is_not_linked_and_only_a_sourced_ros_2_can_have_one(
    kind: Literal["sourced", "wheels"], linked: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_cyclonedds_cpp")
    monkeypatch.setattr(installation, "find_ros", lambda: replace(HERE, kind=kind))
    monkeypatch.setattr(bubblewrap, "usable", lambda: True)
    assert linkable() == linked


def test_a_message_of_turtlesim_cannot_lead_the_page_to_another_address(monkeypatch: pytest.MonkeyPatch) -> None:
    """turtlesim prints names that a node in the cell has sent."""

    async def start(program: programs.Program, *_: object) -> None:
        monkeypatch.setattr(program, "_process", object())
        program.lines.extend(["See the turtle move: http://127.0.0.1:1234/#own", "Spawning turtle [turtle1]"])

    monkeypatch.setattr(programs.Program, "start", start)
    made = programs.Programs(lambda: None, None)
    asyncio.run(made.start_turtlesim())
    made.turtlesim.lines.extend(["See the turtle move: http://127.0.0.1:1/#forged"] * programs.KEPT)
    assert made.address() == Address(1234, "own")


def test_the_reason_why_a_sandbox_does_not_start_ends_with_one_full_stop() -> None:
    failing = ["sh", "-c", "echo 'bwrap: Not allowed.'"]
    with (
        subprocess.Popen(failing, stdout=subprocess.PIPE) as process,
        pytest.raises(MachineError, match=r"did not start: bwrap: Not allowed\. Check this machine with "),
    ):
        LinkedCell(process, DefaultSelector()).await_ready()
