from pathlib import Path

from my_robot_controller.wall_guard import WallGuard

Path("/tmp/left-by-a-test").write_text("I was here")


def test_it():
    assert WallGuard
