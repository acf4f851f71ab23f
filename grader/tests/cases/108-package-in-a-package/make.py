"""`ros2 pkg create` was run once more, inside the package: the outer one is what colcon builds."""
import shutil
from pathlib import Path


def make(folder: Path) -> None:
    package = folder / "my_robot_controller"
    shutil.copytree(package, folder / "inner")
    (folder / "inner").rename(package / "my_robot_controller" / "my_robot_controller")
