from pathlib import Path


def make(folder: Path) -> None:
    bag = folder / "my_robot_controller/circle_bag"
    file = bag / "circle_bag_0.mcap"
    file.write_bytes(file.read_bytes()[:20_000])
