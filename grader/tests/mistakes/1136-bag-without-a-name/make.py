from pathlib import Path


def make(folder: Path) -> None:
    bag = folder / "my_robot_controller/circle_bag"
    bag.rename(bag.with_name("rosbag2_2026_11_23-10_00_00"))
