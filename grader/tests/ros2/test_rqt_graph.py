"""rqt_graph as a user types it, beside turtlesim and draw_circle, on the real ROS 2."""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from PIL import Image

from grader.tests.ros2.world import SOLUTION, World, world

if TYPE_CHECKING:
    from collections.abc import Iterator

GOLDEN = Path(__file__).parents[1] / "golden/graph"


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    yield from world(tmp_path_factory.mktemp("alone"))


@pytest.fixture(scope="module")
def tutorial(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    for made in world(tmp_path_factory.mktemp("tutorial")):
        made.turtlesim()
        made.start(f"python3 {SOLUTION}/my_robot_controller/draw_circle.py", "Draw")
        yield made


def test_the_graph_of_the_tutorial_is_drawn(tutorial: World) -> None:
    done = tutorial.run("rqt_graph --output graph.dot")
    assert (done.code, done.stdout, done.stderr) == (0, "", "")
    assert (tutorial.home / "graph.dot").read_text() == (GOLDEN / "tutorial.dot").read_text()


def test_pictures_are_written(tutorial: World) -> None:
    done = tutorial.run("rqt_graph -o graph.svg && rqt_graph -o graph.png")
    assert (done.code, done.stderr) == (0, "")
    svg = (tutorial.home / "graph.svg").read_text()
    assert all(f"<title>{name}</title>" in svg for name in ("/draw_circle", "/turtle1/cmd_vel", "/turtlesim"))
    assert Image.open(io.BytesIO((tutorial.home / "graph.png").read_bytes())).width > 500


def test_in_a_plain_terminal_it_is_text(tutorial: World) -> None:
    done = tutorial.run("rqt_graph")
    assert (done.code, done.stdout) == (0, (GOLDEN / "tutorial.unicode.txt").read_text())


def test_a_terminal_without_unicode_gets_ascii(tutorial: World) -> None:
    done = tutorial.run("rqt_graph", PYTHONIOENCODING="ascii")
    assert (done.code, done.stdout) == (0, (GOLDEN / "tutorial.ascii.txt").read_text())


def test_active_topics_only(tutorial: World) -> None:
    assert "/turtle1/pose" not in tutorial.run("rqt_graph --active").stdout


def test_all_shows_debug_topics_and_the_inside_of_actions_but_not_itself(tutorial: World) -> None:
    shown = tutorial.run("rqt_graph --all").stdout
    assert all(f"[{name}]" in shown for name in ("/rosout", "/turtle1/rotate_absolute/_action/feedback"))
    assert "rqt_graph" not in shown


def test_without_grader_env_it_finds_ros_by_itself(tutorial: World) -> None:
    kept = {"PATH", "HOME", "LANG", "ROS_DOMAIN_ID"}
    bare = World(tutorial.home, {name: value for name, value in tutorial.env.items() if name in kept})
    cache = os.environ.get("XDG_CACHE_HOME", str(Path.home() / ".cache"))
    done = bare.run("rqt_graph", XDG_CACHE_HOME=cache)
    assert (done.code, done.stdout, done.stderr) == (0, (GOLDEN / "tutorial.unicode.txt").read_text(), "")


@pytest.mark.parametrize(("viewer", "opened"), [("exit 0", True), ("exit 3", False)])
def test_where_there_is_a_screen_the_picture_is_opened(
    tutorial: World, tmp_path: Path, viewer: str, opened: bool
) -> None:
    program = tmp_path / "xdg-open"
    program.write_text(f'#!/bin/sh\ncp "$1" {tmp_path}/seen.png\n{viewer}\n')
    program.chmod(0o755)
    screen = {"PATH": f"{tmp_path}:{tutorial.env['PATH']}", "DISPLAY": ":0", "TMPDIR": str(tmp_path)}
    before_it = World(tutorial.home, {**tutorial.env, **screen})
    done = before_it.run("rqt_graph")
    assert done.code == 0
    assert Image.open(tmp_path / "seen.png").format == "PNG"
    assert done.stdout.startswith("Opened ") == opened
    assert ("[/turtle1/cmd_vel]" in done.stdout) != opened
    (tmp_path / "seen.png").unlink()
    assert "[/turtle1/cmd_vel]" in before_it.run("rqt_graph --text").stdout
    assert not (tmp_path / "seen.png").exists()


# --- wrong use ------------------------------------------------------------------------------------------------------


def test_where_nothing_is_running_it_says_what_to_start(alone: World) -> None:
    done = alone.run("rqt_graph --output nothing.svg")
    assert (done.code, done.stdout) == (1, "")
    assert f"ROS_DOMAIN_ID is {alone.env['ROS_DOMAIN_ID']}" in done.stderr
    assert "ros2 run turtlesim turtlesim_node" in done.stderr
    assert not (alone.home / "nothing.svg").exists()


@pytest.mark.parametrize(
    ("output", "said"),
    [
        ("graph.gif", ".svg, .png or .dot"),
        ("graph", ".svg, .png or .dot"),
        ("no/graph.svg", "no folder"),
        ("", ".svg, .png or .dot"),
    ],
)
def test_a_wrong_output_is_told_before_anything_is_done(alone: World, output: str, said: str) -> None:
    done = alone.run(f"rqt_graph --output '{output}'")
    assert (done.code, done.stdout) == (2, "")
    assert said in done.stderr


def test_a_file_that_cannot_be_written_is_told(tutorial: World) -> None:
    (tutorial.home / "folder.svg").mkdir(exist_ok=True)
    done = tutorial.run("rqt_graph --output folder.svg")
    assert done.code == 2
    assert "folder.svg could not be written" in done.stderr


def test_a_broken_pipe_and_an_unknown_option_end_without_a_traceback(tutorial: World) -> None:
    assert "Traceback" not in tutorial.run("rqt_graph | true").stderr
    done = tutorial.run("rqt_graph --everything")
    assert done.code == 2
    assert "Traceback" not in done.stderr


def test_a_sourced_rqt_graph_is_used(alone: World, tmp_path: Path) -> None:
    (tmp_path / "share/ament_index/resource_index/packages").mkdir(parents=True)
    (tmp_path / "share/ament_index/resource_index/packages/rqt_graph").touch()
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/rqt_graph").write_text('#!/bin/sh\necho "the real one: $*"\n')
    (tmp_path / "bin/rqt_graph").chmod(0o755)
    done = alone.run("rqt_graph --force-discover", AMENT_PREFIX_PATH=f"{alone.env['AMENT_PREFIX_PATH']}:{tmp_path}")
    assert done.stdout == "the real one: --force-discover\n"
