"""A user starts rqt_graph, turtlesim and draw_circle with a real ROS 2."""

from __future__ import annotations

import io
import json
import os
import socket
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from PIL import Image
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect
from websockets.typing import Origin

from grader.tests.both_worlds import SOURCED_ENV, of_our_rqt_graph
from grader.tests.ros2.world import SOLUTION, World, world
from grader.tests.waiting import until

if TYPE_CHECKING:
    from collections.abc import Iterator

TUTORIAL = {
    ("/draw_circle", "/turtle1/cmd_vel"),
    ("/turtle1/cmd_vel", "/turtlesim"),
    ("/turtlesim", "/turtle1/color_sensor"),
    ("/turtlesim", "/turtle1/pose"),
}
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


@of_our_rqt_graph
def test_in_a_plain_terminal_it_is_text(tutorial: World) -> None:
    done = tutorial.run("rqt_graph")
    assert (done.code, done.stdout) == (0, (GOLDEN / "tutorial.unicode.txt").read_text())


@of_our_rqt_graph
def test_a_terminal_without_unicode_gets_ascii(tutorial: World) -> None:
    done = tutorial.run("rqt_graph", PYTHONIOENCODING="ascii")
    assert (done.code, done.stdout) == (0, (GOLDEN / "tutorial.ascii.txt").read_text())


def test_active_topics_only(tutorial: World) -> None:
    assert "/turtle1/pose" not in tutorial.run("rqt_graph --active").stdout


def test_all_shows_debug_topics_and_the_inside_of_actions_but_not_itself(tutorial: World) -> None:
    shown = tutorial.run("rqt_graph --all").stdout
    assert all(f"[{name}]" in shown for name in ("/rosout", "/turtle1/rotate_absolute/_action/feedback"))
    assert "rqt_graph" not in shown


@of_our_rqt_graph
def test_without_grader_env_it_finds_ros_by_itself(tutorial: World) -> None:
    kept = {"PATH", "HOME", "LANG", "ROS_DOMAIN_ID", *SOURCED_ENV}
    bare = World(tutorial.home, {name: value for name, value in tutorial.env.items() if name in kept})
    cache = os.environ.get("XDG_CACHE_HOME", str(Path.home() / ".cache"))
    done = bare.run("rqt_graph", XDG_CACHE_HOME=cache)
    assert (done.code, done.stdout, done.stderr) == (0, (GOLDEN / "tutorial.unicode.txt").read_text(), "")


@pytest.fixture
def before_a_screen(tutorial: World, tmp_path: Path) -> Iterator[World]:
    """Create a desktop whose browser writes the address to a file, or fails if BROKEN is set."""
    program = tmp_path / "xdg-open"
    program.write_text(f'#!/bin/sh\necho "$1" > {tmp_path}/opened\nexit ${{BROKEN:-0}}\n')
    program.chmod(0o755)
    made = World(tutorial.home, {**tutorial.env, "PATH": f"{tmp_path}:{tutorial.env['PATH']}", "DISPLAY": ":0"})
    yield made
    made.end()


@of_our_rqt_graph
def test_where_there_is_a_browser_the_graph_is_shown_live_until_ctrl_c(before_a_screen: World, tmp_path: Path) -> None:
    graph = before_a_screen.start("rqt_graph", "http://127.0.0.1:")
    until(lambda: (tmp_path / "opened").exists() and bool((tmp_path / "opened").read_text()))
    address = (tmp_path / "opened").read_text().strip()
    (reported,) = graph.lines
    printed = reported.removeprefix("The graph, live until Ctrl-C: ")
    # The page is the same, but since other users can read command lines, the address has a code that works only once.
    assert printed.partition("/#")[0] == address.partition("/#")[0]
    assert printed != address
    host, _, token = address.removeprefix("http://").partition("/#")
    with connect(f"ws://{host}/live?token={token}", origin=Origin(f"http://{host}")) as page:
        assert json.loads(page.recv()) == {"kind": "token", "token": printed.partition("/#")[2]}
        graphs = (news["graph"]["wide"] for news in map(json.loads, page) if news["kind"] == "graph")
        # The first drawing may be incomplete, because discovery may still be running.
        shown = next(each for each in graphs if len(each["arrows"]) == len(TUTORIAL))
    with pytest.raises(InvalidStatus), connect(f"ws://{host}/live?token={token}", origin=Origin(f"http://{host}")):
        pass
    labels = {node["label"] for node in shown["nodes"]}
    assert {(each["from"], each["to"]) for each in shown["arrows"]} == TUTORIAL
    assert not any("rqt_graph" in label or "view" in label for label in labels)
    assert graph.stop() == 0
    assert not any("Traceback" in line for line in graph.lines)


@of_our_rqt_graph
def test_where_the_browser_cannot_be_started_it_is_text(before_a_screen: World) -> None:
    done = before_a_screen.run("rqt_graph", BROKEN="3")
    assert done.code == 0
    assert "[/turtle1/cmd_vel]" in done.stdout


def test_text_is_printed_also_where_there_is_a_browser(before_a_screen: World, tmp_path: Path) -> None:
    assert "[/turtle1/cmd_vel]" in before_a_screen.run("rqt_graph --text").stdout
    assert not (tmp_path / "opened").exists()


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
        ("no/graph.svg", "does not exist"),
        ("", ".svg, .png or .dot"),
    ],
)
def test_a_wrong_output_is_reported_before_anything_is_done(alone: World, output: str, said: str) -> None:
    done = alone.run(f"rqt_graph --output '{output}'")
    assert (done.code, done.stdout) == (2, "")
    assert said in done.stderr


def test_a_file_that_cannot_be_written_is_reported(tutorial: World) -> None:
    (tutorial.home / "folder.svg").mkdir(exist_ok=True)
    done = tutorial.run("rqt_graph --output folder.svg")
    assert done.code == 2
    assert "folder.svg could not be written" in done.stderr


def test_a_broken_pipe_and_an_unknown_option_end_without_a_traceback(tutorial: World) -> None:
    assert "Traceback" not in tutorial.run("rqt_graph --text | true").stderr
    done = tutorial.run("rqt_graph --text --everything")
    assert done.code == 2
    assert "Traceback" not in done.stderr


def real_one(prefix: Path) -> None:
    """Create a ROS 2 that has its own rqt_graph."""
    (prefix / "share/ament_index/resource_index/packages").mkdir(parents=True)
    (prefix / "share/ament_index/resource_index/packages/rqt_graph").touch()
    (prefix / "bin").mkdir()
    (prefix / "bin/rqt_graph").write_text('#!/bin/sh\necho "the real one: $*"\n')
    (prefix / "bin/rqt_graph").chmod(0o755)


def test_a_sourced_rqt_graph_is_used(alone: World, tmp_path: Path) -> None:
    real_one(tmp_path)
    done = alone.run("rqt_graph --force-discover", AMENT_PREFIX_PATH=f"{tmp_path}:{alone.env['AMENT_PREFIX_PATH']}")
    assert done.stdout == "the real one: --force-discover\n"


@pytest.mark.parametrize("option", ["--text", "--output graph.dot", "--output=graph.dot", "-o graph.dot"])
def test_a_sourced_rqt_graph_does_not_get_options_that_it_does_not_know(
    alone: World, tmp_path: Path, option: str
) -> None:
    real_one(tmp_path)
    done = alone.run(f"rqt_graph {option}", AMENT_PREFIX_PATH=f"{tmp_path}:{alone.env['AMENT_PREFIX_PATH']}")
    assert (done.code, done.stdout) == (1, "")
    assert "No node was found" in done.stderr


def test_what_may_be_missing_is_reported(tutorial: World) -> None:
    # This process uses the port of a participant but sends nothing, like a stopped process.
    port = 7400 + 250 * int(tutorial.env["ROS_DOMAIN_ID"]) + 10 + 2 * 100
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as silent:
        silent.bind(("127.0.0.1", port))
        done = tutorial.run("rqt_graph --text")
    assert done.code == 0
    assert "the graph may be incomplete" in done.stderr
