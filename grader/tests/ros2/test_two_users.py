"""Two classmates on one machine, each with a turtlesim: neither hears the other, nor drives the other's turtle."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

import pytest

from grader import ros, underlay
from grader.tests.ros2.world import SOLUTION, World, environment

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

NAMES = ("ada", "grace")


@pytest.fixture
def classmates(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[list[World]]:
    """Two users whose numbers follow each other; other ones in each run, so that two runs do not meet."""
    made = []
    for number, name in enumerate(NAMES, start=1000 + os.getpid() % 90):
        home = tmp_path / name
        home.mkdir()
        monkeypatch.setattr(os, "getuid", lambda number=number: number)
        made.append(World(home, of_user(home)))
    monkeypatch.undo()
    yield made
    for world in made:
        world.end()


def of_user(home: Path) -> dict[str, str]:
    """What `grader env` gives somebody who has chosen nothing."""
    here = ros.find_ros()
    chosen_nothing = {
        key: value
        for key, value in environment(home).items()
        if key not in {"ROS_DOMAIN_ID", "ROS_AUTOMATIC_DISCOVERY_RANGE"}
    }
    return ros.users_environment(here, underlay.ensure(here), chosen_nothing)


def test_classmates_do_not_hear_each_other(classmates: list[World]) -> None:
    ada, grace = classmates
    for user in classmates:
        user.turtlesim()
    ada.start(f"python3 {SOLUTION}/my_robot_controller/draw_circle.py", "Draw")
    # From here on her turtle is driven.
    ada.start("ros2 topic echo /turtle1/pose --csv", ",2.0,1.0")
    assert grace.run("ros2 node list").stdout == "/turtlesim\n"
    assert "Publisher count: 0" in grace.run("ros2 topic info /turtle1/cmd_vel").stdout
    still = grace.run("ros2 topic echo /turtle1/pose --once --csv").stdout
    assert still.startswith("5.544444561004639,5.544444561004639,0.0,0.0,0.0")
    assert ada.run("ros2 node list").stdout.split() == ["/draw_circle", "/turtlesim"]


def test_nobody_on_the_network_is_heard(classmates: list[World]) -> None:
    assert {user.env["ROS_AUTOMATIC_DISCOVERY_RANGE"] for user in classmates} == {"LOCALHOST"}


def test_who_wants_to_can_share_a_domain(classmates: list[World]) -> None:
    ada, grace = classmates
    shared = World(grace.home, {**grace.env, "ROS_DOMAIN_ID": ada.env["ROS_DOMAIN_ID"]})
    ada.turtlesim()
    assert shared.run("ros2 node list").stdout == "/turtlesim\n"
    assert grace.run("ros2 node list").stdout == ""


def test_users_whose_numbers_lie_close_have_different_domains() -> None:
    domain: Callable[[int], int] = ros.domain_of
    assert len({domain(number) for number in range(1000, 1100)}) == 100
    # 0 is everybody's who has chosen none; above 101 the ports are given out by Linux itself.
    assert {domain(number) for number in range(100_000)} == set(range(1, 102))
