"""`grader sim --view` starts the view. A view that is killed does not stop its simulator."""

from __future__ import annotations

import json
import os
import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from websockets.sync.client import connect
from websockets.typing import Origin

from grader.tests.both_worlds import OUR_TURTLESIM, REAL_TURTLESIM
from grader.tests.ros2.world import World, world
from grader.tests.waiting import HANG_S, only_child, until_gone

if TYPE_CHECKING:
    from collections.abc import Iterator

    from grader.tests.ros2.world import Running


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Iterator[World]:
    yield from world(tmp_path_factory.mktemp("command"))


def program(of: Running) -> int:
    """Return the process id of the simulator: `grader sim` becomes this process, and `ros2 run` starts it."""
    return of.process.pid if REAL_TURTLESIM else of.program


def whole(of: Running) -> dict[str, Any]:
    """Return the first message that a page receives. The view may still be starting."""
    url = next(word for line in of.lines for word in line.split() if word.startswith("http://"))
    host, _, token = url.removeprefix("http://").partition("/#")
    address = f"ws://{host}/live?token={token}"
    with connect(address, origin=Origin(f"http://{host}"), open_timeout=HANG_S) as page:
        reported: dict[str, Any] = json.loads(page.recv())
        return reported


def test_grader_sim_shows_its_turtle_and_takes_parameters(alone: World) -> None:
    # Share the cache, because building takes a long time.
    cache = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    simulator = alone.start("grader sim --view --ros-args -p background_r:=7", "Spawning turtle", XDG_CACHE_HOME=cache)
    while not (reported := whole(simulator))["turtles"]:
        pass
    assert list(reported["turtles"]) == ["turtle1"]
    assert reported["background"] == [7, 86, 255]
    assert simulator.stop() == 0
    for line in ("turtlesim in ROS domain ", "See the turtle move: http://127.0.0.1:"):
        assert any(each.startswith(line) for each in simulator.lines), line
    assert not any("Traceback" in line for line in simulator.lines)


@pytest.mark.parametrize("typed", ["--view terminal", "--view=terminal"])
def test_grader_sim_can_draw_in_the_terminal_and_says_when_there_is_none(alone: World, typed: str) -> None:
    cache = os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache")
    done = alone.run(f"grader sim {typed}", XDG_CACHE_HOME=cache)
    assert done.code == 2
    assert "--view terminal needs a terminal" in done.stderr


@pytest.mark.parametrize(
    ("variable", "value", "todo"),
    [
        ("ROS_LOG_DIR", "/dev/null/log", "Choose a folder that you can write to: export ROS_LOG_DIR=FOLDER"),
        ("ROS_DOMAIN_ID", "abc", "To use the usual domain, type: unset ROS_DOMAIN_ID"),
    ],
)
def test_what_keeps_turtlesim_from_starting_says_what_to_do(alone: World, variable: str, value: str, todo: str) -> None:
    done = alone.run(OUR_TURTLESIM, **{variable: value})
    assert "Traceback" not in done.stderr
    assert todo in done.stderr


def test_a_simulator_outlives_its_view(alone: World) -> None:
    simulator = alone.start(f"{OUR_TURTLESIM} --view", "Spawning turtle")
    view = only_child(program(simulator))
    os.kill(view, signal.SIGKILL)
    simulator.wait_for("The view has ended. turtlesim continues without it.")
    assert alone.run("ros2 topic echo /turtle1/pose --once").code == 0
    assert simulator.stop() == 0


def test_a_view_does_not_outlive_its_simulator(alone: World) -> None:
    simulator = alone.start(f"{OUR_TURTLESIM} --view", "Spawning turtle")
    whole(simulator)
    view = only_child(program(simulator))
    os.kill(program(simulator), signal.SIGKILL)
    simulator.process.wait()
    until_gone(view)  # it may have ended before the wait for its simulator has returned


def test_nothing_of_the_view_is_imported_without_it(alone: World) -> None:
    listed = "[name for name in sys.modules if 'starlette' in name or 'grader.view.' in name]"
    code = f"import sys, grader.turtlesim.standalone, grader.view.turtlesim_node; print({listed})"
    assert alone.run(f'{sys.executable} -c "{code}"').stdout == "['grader.view.turtlesim_node']\n"
