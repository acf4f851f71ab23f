from pathlib import Path

from grader.tests import made_bag


def make(folder: Path) -> None:
    bag = folder / "my_robot_controller/circle_bag"
    poses = made_bag.poses(begin_s=4.0, drive_s=10.0, end_s=4.0)
    made_bag.record(bag, [*poses, *made_bag.commands(18.0)])
