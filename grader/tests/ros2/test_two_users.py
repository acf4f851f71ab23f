"""Two users of one machine: each has a turtle, and neither discovers or drives the turtle of the other."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.ros import installation, underlay
from grader.setup import machine
from grader.tests.both_worlds import of_the_wheels
from grader.tests.domains import own_domain
from grader.tests.ros2.world import World
from grader.tests.waiting import LONG_S, until

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = of_the_wheels
DRIVE = "ros2 topic pub --once /turtle1/cmd_vel geometry_msgs/msg/Twist '{linear: {x: 2.0}}'"
WHERE = "ros2 topic echo --once --csv /turtle1/pose"
START = "5.544444561004639,5.544444561004639,0.0,0.0,0.0\n"


@pytest.fixture
def users(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[list[World]]:
    """Create the environments that `grader env` prints for two users."""
    ros = underlay.with_turtlesim(installation.find_ros())
    worlds = []
    # The processes of other tests are in other domains.
    domains = [own_domain(), own_domain()]
    for uid in [next(uid for uid in count(2000) if installation.domain_of(uid) == domain) for domain in domains]:
        home = tmp_path / str(uid)
        home.mkdir()
        monkeypatch.setattr(os, "getuid", lambda uid=uid: uid)
        worlds.append(
            World(
                home,
                installation.users_environment(
                    ros, {"HOME": str(home), "PATH": os.environ["PATH"], "GRADER_ROS2_DAEMON": "0"}
                ),
            )
        )
    monkeypatch.undo()
    yield worlds
    for world in worlds:
        world.end()


def test_neither_drives_the_others_turtle(users: list[World]) -> None:
    one, other = users
    for user in users:
        user.turtlesim()
        assert user.env["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"
    assert one.env["ROS_DOMAIN_ID"] != other.env["ROS_DOMAIN_ID"]
    assert one.run("ros2 node list").stdout == other.run("ros2 node list").stdout == "/turtlesim\n"
    assert one.run(DRIVE).code == 0
    until(lambda: one.run(WHERE).stdout != START)
    assert other.run(WHERE).stdout == START
    # With the same domain, the two users would share the turtle.
    assert other.run(DRIVE.replace("2.0", "-2.0"), ROS_DOMAIN_ID=one.env["ROS_DOMAIN_ID"]).code == 0
    assert other.run(WHERE).stdout == START


@pytest.fixture
def everybodys_folder() -> Iterator[Path]:
    """Create a folder that other users can open, unlike pytest's folders."""
    with tempfile.TemporaryDirectory() as name:
        Path(name).chmod(0o755)
        yield Path(name)


@pytest.mark.exhaustive
@pytest.mark.skipif(os.getuid() != 0, reason="only root can become two others")
def test_two_real_users(everybodys_folder: Path) -> None:
    uids, domains = (2000, 2001), set()
    for uid in uids:
        home = everybodys_folder / f"real{uid}"
        home.mkdir()
        os.chown(home, uid, uid)
        command = f"source <({sys.prefix}/bin/grader env) && echo $ROS_DOMAIN_ID && ros2 topic list -c"
        done = subprocess.run(
            ["bash", "-c", command],
            env={"HOME": str(home), "PATH": "/usr/bin:/bin", "LANG": "C.UTF-8", "GRADER_ROS2_DAEMON": "0"},
            cwd=home,
            user=uid,
            group=uid,
            extra_groups=[],
            capture_output=True,
            text=True,
            timeout=LONG_S,
            check=False,
        )
        if "Permission denied" in done.stderr and machine.closed_folder(sys.prefix):
            pytest.skip("other users cannot access this Python")
        assert done.returncode == 0, done.stderr
        domain, topics = done.stdout.split()
        assert topics == "2"
        domains.add(domain)
    assert domains == {str(installation.domain_of(uid)) for uid in uids}
