from pathlib import Path

from grader.tests import made_bag


def make(folder: Path) -> None:
    bag = folder / "my_robot_controller/circle_bag"
    made_bag.record_compressed(bag)
