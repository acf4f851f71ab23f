"""`grader run` builds the learner's package and runs its node together with a turtlesim. Ctrl-C ends both programs."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import signal
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING

import pexpect
import pytest

from grader.errors import UsageError
from grader.learner import steps
from grader.learner.run_node import program_of
from grader.tests.domains import separate_domain
from grader.tests.learner.story import Learner
from grader.tests.waiting import until

if TYPE_CHECKING:
    from collections.abc import Iterator

NODE = "src/my_robot_controller/my_robot_controller/draw_circle.py"


@pytest.fixture(scope="module")
def learner(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Learner]:
    """Create a learner who has solved step 03."""
    learner = Learner(tmp_path_factory.mktemp("home"))
    learner.reads("start", "03")
    learner.solves("03-circle-publisher")
    with separate_domain() as domain:
        learner.env["ROS_DOMAIN_ID"] = str(domain)
        yield learner


def children_of(pid: int) -> list[int]:
    found = subprocess.run(["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True, check=False)
    return [int(word) for word in found.stdout.split()]


def test_one_command_shows_the_turtle_and_ctrl_c_ends_everything(learner: Learner) -> None:
    child = learner.types("run")
    child.expect("See the turtle move: http://127")
    child.expect("draw_circle is running")
    child.expect(r"\[draw_circle\]: ")
    started = children_of(child.pid)
    assert len(started) == 2, "a turtlesim and a node"
    child.sendintr()
    child.expect(pexpect.EOF)
    child.close()
    assert child.exitstatus == 0
    assert [pid for pid in started if Path(f"/proc/{pid}").exists()] == []


def test_ctrl_c_stops_only_the_program_if_another_turtlesim_is_running(learner: Learner) -> None:
    simulator = learner.types("sim")
    simulator.expect("Spawning turtle")
    child = learner.types("run", "--no-view")
    child.expect("A turtlesim is already running, and the node uses it.")
    child.expect(r"Press Ctrl-C to stop the program\.")
    child.expect(r"\[draw_circle\]: ")
    child.sendintr()
    child.expect(pexpect.EOF)
    assert simulator.isalive()
    simulator.sendintr()
    simulator.expect(pexpect.EOF)


def test_sigterm_in_a_terminal_ends_the_node_as_ctrl_c_does(learner: Learner) -> None:
    child = learner.types("run", "--no-view")
    child.expect(r"\[draw_circle\]: ")
    child.kill(signal.SIGTERM)
    child.expect(pexpect.EOF)
    assert "did not end" not in child.before


def test_a_crash_shows_the_learners_own_file(learner: Learner) -> None:
    node = learner.home / "ros2_ws" / NODE
    right = node.read_text("utf-8")
    node.write_text(right.replace("Twist()", "Twits()"), "utf-8")
    printed = learner.reads("run", "03", "draw_circle", "--no-view")
    node.write_text(right, "utf-8")
    assert f'File "{node}", line ' in printed
    assert "NameError: name 'Twits' is not defined" in printed
    assert "draw_circle ended with exit code 1." in printed


def test_a_node_that_a_signal_ends_names_the_signal(learner: Learner) -> None:
    node = learner.home / "ros2_ws" / NODE
    right = node.read_text("utf-8")
    node.write_text(f"import os\n{right}".replace("Twist()", "os.kill(os.getpid(), 11)"), "utf-8")
    printed = learner.reads("run", "03", "draw_circle", "--no-view")
    node.write_text(right, "utf-8")
    assert "draw_circle was killed (SIGSEGV)." in printed


def test_a_folder_that_names_no_step_asks_for_a_step(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"Type `grader run STEP`, one of: 01-first-node"):
        program_of(str(tmp_path), None, tmp_path / "no_ws")


@pytest.mark.parametrize("typed", ["", "src", "src/my_robot_controller"])
def test_a_package_in_another_workspace_names_this_workspace(tmp_path: Path, typed: str) -> None:
    other = tmp_path / "my ws"
    steps.start("03", other)
    with pytest.raises(UsageError) as caught:
        program_of(str(other / typed), None, tmp_path / "no_ws")
    (command,) = re.findall("`(grader run STEP [^`]*)`", str(caught.value))
    grader, run, step, option, workspace = shlex.split(command)
    assert (grader, run, step, option) == ("grader", "run", "STEP", "--workspace")
    assert program_of("03", None, Path(workspace)).folder == other / "src/my_robot_controller"


def test_a_failed_build_shows_the_messages_of_colcon(learner: Learner) -> None:
    setup = learner.home / "ros2_ws/src/my_robot_controller/setup.py"
    right = setup.read_text("utf-8")
    setup.write_text(right.replace("setup(", "setup((", 1), "utf-8")
    printed = learner.reads("run")
    setup.write_text(right, "utf-8")
    assert "SyntaxError" in printed
    assert "The package could not be built. See the messages of colcon above." in printed


def test_a_package_with_another_name_is_not_said_to_fail_to_build(learner: Learner) -> None:
    manifest = learner.home / "ros2_ws/src/my_robot_controller/package.xml"
    before = manifest.read_text("utf-8")
    manifest.write_text(before.replace("<name>my_robot_controller</name>", "<name>my_robot</name>"), "utf-8")
    printed = " ".join(learner.reads("run").split())
    manifest.write_text(before, "utf-8")
    assert f"colcon found no package my_robot_controller in {manifest.parent}." in printed
    assert "could not be built" not in printed


def test_a_program_outside_lib_names_both_files_that_can_be_wrong(learner: Learner) -> None:
    setup = learner.home / "ros2_ws/src/my_robot_controller/setup.cfg"
    before = setup.read_text("utf-8")
    setup.write_text("", "utf-8")
    printed = " ".join(learner.reads("run", "03").split())
    setup.write_text(before, "utf-8")
    assert "The package has no executable draw_circle in lib/my_robot_controller." in printed
    assert "console_scripts" in printed
    assert "the folders in setup.cfg." in printed


@pytest.mark.parametrize("setting", ["symlink-install: true", "merge-install: true", "packages-select: [other]", "["])
def test_the_users_settings_of_colcon_are_for_the_workspace(learner: Learner, setting: str) -> None:
    folder = Path(learner.env["HOME"], ".colcon")
    folder.mkdir()
    folder.joinpath("defaults.yaml").write_text(f"build:\n  {setting}\n")
    try:
        child = learner.types("run")
        child.expect(r"\[draw_circle\]: ")
        child.sendintr()
        child.expect(pexpect.EOF)
    finally:
        shutil.rmtree(folder)


def test_it_names_what_it_can_run(learner: Learner) -> None:
    told = " ".join(learner.reads("run", "03", "drawcircle").split())
    assert "Did you mean draw_circle? Its programs: draw_circle." in told
    learner.reads("start", "02")
    assert "02-discover-topics has no node to run." in learner.reads("run")


def test_a_program_in_the_place_of_a_step_names_the_step() -> None:
    with pytest.raises(UsageError, match=r"draw_circle is a program, not a step\. Type: grader run 03 draw_circle"):
        program_of("draw_circle", None, None)


def test_a_terminal_that_is_closed_during_the_build_leaves_nothing(learner: Learner, tmp_path: Path) -> None:
    setup = learner.home / "ros2_ws/src/my_robot_controller/setup.py"
    before = setup.read_text()
    setup.write_text("import time\ntime.sleep(3.0)\n")
    learner.env["TMPDIR"] = str(tmp_path)
    try:
        child = learner.types("run", "03")
        until(lambda: any(tmp_path.glob("*/grader-*/log")))
        child.kill(signal.SIGHUP)
        child.expect(pexpect.EOF)
        assert [path for path in tmp_path.rglob("*") if path.suffix != ".lock"] == [
            tmp_path / f"ros2-grader-{os.getuid()}"
        ]
    finally:
        del learner.env["TMPDIR"]
        setup.write_text(before)


def test_nothing_is_left_in_the_workspace(learner: Learner) -> None:
    assert sorted(path.name for path in (learner.home / "ros2_ws").iterdir()) == ["answers", "src"]
