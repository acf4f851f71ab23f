"""The lessons are correct: commands and code work, recorded answers are the answers of ROS 2, and pictures exist."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import pexpect
import pytest

from grader.authoring.console_blocks import Block, blocks
from grader.authoring.validate import lesson_problems
from grader.cli import app
from grader.common.interpreter import interpreter
from grader.ros.installation import environment, find_ros
from grader.ros.underlay import with_turtlesim
from grader.submission.answers_toml import read_answers
from grader.submission.package_xml import read_manifest
from grader.tests.console import differs, run
from grader.tests.domains import own_domain
from grader.tests.learner.story import Learner
from grader.tests.waiting import HANG_S, LONG_S

if TYPE_CHECKING:
    from collections.abc import Iterator

ROOT = Path(__file__).parent.parent.parent
GOLDEN = Path(__file__).parent / "golden" / "ros2"
LESSONS = sorted((ROOT / "course").glob("*/lesson.md"))
WORDS = range(1200, 2001)
ENDS = re.compile(r"\n\[exit \d+\].*", re.DOTALL)


def blocks_of(language: str, about: str) -> list[object]:
    """Return the blocks of this kind in all lessons, as test parameters named after their lessons."""
    return [
        pytest.param(block, id=f"{lesson.parent.name}-{number}")
        for lesson in LESSONS
        for number, block in enumerate(blocks(lesson.read_text("utf-8")))
        if (block.language, block.about) == (language, about)
    ]


@pytest.fixture(params=LESSONS, ids=lambda lesson: lesson.parent.name)
def lesson(request: pytest.FixtureRequest) -> Path:
    path: Path = request.param
    return path


def test_a_lesson_is_neither_too_short_nor_too_long(lesson: Path) -> None:
    assert len(lesson.read_text("utf-8").split()) in WORDS


def test_links_pictures_and_commands_are_there(lesson: Path) -> None:
    assert list(lesson_problems(lesson, app)) == []


def test_every_block_says_what_it_is(lesson: Path) -> None:
    kinds = {(block.language, block.about) for block in blocks(lesson.read_text("utf-8"))}
    assert kinds <= {
        ("console", ""),
        ("console", "solved"),
        ("console", "ros2"),
        ("console", "kitchen"),
        ("console", "running"),
        ("python", ""),
        ("python", "part"),
        ("python", "example"),
        ("toml", ""),
        ("xml", ""),
    }


def home_of_a_reader(folder: Path) -> dict[str, str]:
    """Return the variables of a home folder that contains the course at the path that the lessons use."""
    (folder / "home/ros2-course").mkdir(parents=True)
    (folder / "home/ros2-course/.venv").symlink_to(sys.prefix)
    cache = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    return {"HOME": str(folder / "home"), "XDG_CACHE_HOME": cache}


@pytest.mark.parametrize("block", [*blocks_of("console", ""), *blocks_of("console", "solved")])
def test_commands_print_what_the_lesson_shows(block: Block, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    """Run the commands in a workspace in which the step is started, and solved where the lesson says so."""
    step = request.node.callspec.id.rpartition("-")[0]
    env = {**os.environ, "PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}", **home_of_a_reader(tmp_path)}
    env.pop("XDG_STATE_HOME", None)
    reader = Learner(tmp_path / "home")
    reader.reads("start", step)
    if block.about == "solved":
        reader.solves(step)
    for step, printed, _ in run(block, tmp_path, env, LONG_S):
        assert differs(step.printed, printed) is None, printed


@pytest.mark.parametrize("block", blocks_of("console", "ros2"))
def test_answers_of_ros2_are_those_that_were_recorded(block: Block) -> None:
    recorded = [path.read_text("utf-8") for path in sorted(GOLDEN.glob("*.txt"))]
    for step in block.steps():
        # The same command may have been recorded several times, in different situations.
        answers = [ENDS.sub("", text).splitlines() for text in recorded if text.startswith(f"$ {step.command}\n")]
        assert [f"$ {step.command}", *step.printed] in answers


def test_no_command_stands_outside_of_a_block(lesson: Path) -> None:
    """A command outside a block would not be run by any test."""
    assert re.findall(r"^ +\$ .*", lesson.read_text("utf-8"), re.MULTILINE) == []


def test_lesson_05_is_typed_as_it_stands(tmp_path: Path) -> None:
    """Build, run and stop the node. Change the speed without another build. Show the graph."""
    shown = blocks((ROOT / "course/05-build-and-run/lesson.md").read_text("utf-8"))
    build = next(block for block in shown if block.language == "console")
    start, said = next((s.command, s.printed[0]) for b in shown if b.about == "running" for s in b.steps())
    path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
    ours = {"PATH": path, "ROS_DOMAIN_ID": str(own_domain()), "PS1": "", "TERM": "dumb"}
    env = {**os.environ, **ours, **home_of_a_reader(tmp_path)}
    Learner(tmp_path / "home").reads("start", "05")
    shell = pexpect.spawn(
        "bash", ["--norc", "--noprofile"], env=env, cwd=tmp_path, encoding="utf-8", timeout=HANG_S, echo=False
    )
    for command in (step.command for step in build.steps()):
        shell.sendline(f"{command}; echo done''with")
        shell.expect_exact("donewith")
    shell.sendline(start)
    shell.expect_exact(said.rpartition("]: ")[2])
    shell.sendintr()
    shell.sendline("echo stopped''here")
    shell.expect_exact("stoppedhere")

    node = tmp_path / "home/ros2_ws/src/my_robot_controller/my_robot_controller/draw_circle.py"
    text = node.read_text()
    assert "linear.x = 2.0" in text
    node.write_text(text.replace("linear.x = 2.0", "linear.x = 1.5"))
    shell.sendline(f"{start} &")
    shell.sendline("ros2 topic echo /turtle1/cmd_vel geometry_msgs/msg/Twist --once")
    shell.expect_exact("x: 1.5")
    shell.sendline("until rqt_graph --text | grep '(/draw_circle) .*cmd_vel'; do :; done; kill -INT -- -$!; wait; exit")
    shell.expect_exact("(/draw_circle) ───▶ [/turtle1/cmd_vel]")
    shell.expect(pexpect.EOF)
    shell.close()


@pytest.fixture
def kitchen(tmp_path: Path) -> Iterator[dict[str, str]]:
    """Run the thermometer and the heater. Yield the environment of a shell whose ros2 finds both nodes."""
    ros, domain = find_ros(), own_domain()
    with subprocess.Popen(
        [ros.python, Path(__file__).with_name("kitchen.py")],
        env=environment(ros, home=tmp_path, domain=domain),
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        try:
            assert process.stdout is not None
            assert process.stdout.readline() == "running\n"
            path = f"{Path(sys.executable).parent}:{os.environ['PATH']}"
            yield {**os.environ, "PATH": path, "ROS_DOMAIN_ID": str(domain)}
        finally:
            process.terminate()


@pytest.mark.parametrize("block", blocks_of("console", "kitchen"))
def test_questions_about_the_kitchen_have_the_answers_shown(
    block: Block, kitchen: dict[str, str], tmp_path: Path
) -> None:
    shell = replace(block, text=f"$ source <(grader env)\n{block.text}")
    answers = run(shell, tmp_path, kitchen, HANG_S)
    for _ in range(5):  # On a busy machine, discovery may be slow. Then the commands run again.
        if all(differs(step.printed, printed) is None for step, printed, _ in answers):
            break
        answers = run(shell, tmp_path, kitchen, HANG_S)
    for step, printed, _ in answers:
        assert differs(step.printed, printed) is None, printed


@pytest.mark.parametrize("block", blocks_of("python", "part"))
def test_parts_of_files_are_in_the_step(block: Block) -> None:
    """A code block that quotes a part of the solution must be equal to that part."""
    assert any(block.text in path.read_text("utf-8") for path in (ROOT / "solutions").glob("*/**/*.py"))


@pytest.mark.parametrize("block", blocks_of("python", "example"))
def test_examples_can_be_imported(block: Block, tmp_path: Path) -> None:
    ros = with_turtlesim(find_ros())
    done = subprocess.run(
        [ros.python, "-c", block.text],
        env=environment(ros, home=tmp_path, domain=own_domain()),
        capture_output=True,
        text=True,
        timeout=LONG_S,
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, ""), done.stderr


@pytest.mark.parametrize("block", [*blocks_of("toml", ""), *blocks_of("xml", "")])
def test_examples_of_files_can_be_read(block: Block) -> None:
    if block.language == "toml":
        assert read_answers(f"[answers]\n{block.text}".encode()).problem is None
    else:
        assert read_manifest(block.text.encode()).problem is None


@pytest.mark.parametrize("block", blocks_of("python", ""))
def test_the_thermometer_runs_on_the_real_rclpy(block: Block, tmp_path: Path) -> None:
    ros = find_ros()
    # These calls replace `main`, which would not end.
    calls = (
        "rclpy.init()\nnode = ThermometerNode()\nnode.announce()\nprint(node.get_name(), node.timer.timer_period_ns)"
    )
    code = f"{block.text}\n{calls}"
    done = subprocess.run(
        [ros.python, "-c", code],
        env=environment(ros, home=tmp_path, domain=own_domain()),
        capture_output=True,
        text=True,
        timeout=LONG_S,
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, "thermometer 2000000000\n"), done.stderr


def test_the_tests_of_the_kettle_pass(tmp_path: Path) -> None:
    """pytest runs the blocks of lesson 12 as one file. If the kettle never switches off, tests fail."""
    shown = blocks((ROOT / "course/12-tests/lesson.md").read_text("utf-8"))
    code = "\n\n".join(block.text for block in shown if (block.language, block.about) == ("python", "example"))
    (tmp_path / "test_kettle.py").write_text(code, "utf-8")
    (tmp_path / "test_broken.py").write_text(code.replace("self.degrees < 90.0", "True"), "utf-8")
    ros = find_ros()
    start = interpreter(
        "-m", "pytest", "-q", python=str(ros.python), env=environment(ros, home=tmp_path), searches=True
    )
    env = {**start.env, "ROS_AUTOMATIC_DISCOVERY_RANGE": "OFF"}
    done = subprocess.run(
        start.argv, cwd=tmp_path, env=env, capture_output=True, text=True, timeout=LONG_S, check=False
    )
    assert "2 failed, 8 passed" in done.stdout, done.stdout
    assert "test_kettle" not in done.stdout.partition("short test summary")[2]
