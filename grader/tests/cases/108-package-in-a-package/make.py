"""`ros2 pkg create` was run again inside the package. colcon builds the outer package."""
import shutil
from pathlib import Path


def make(folder: Path) -> None:
    package = folder / "my_robot_controller"
    shutil.copytree(package, folder / "inner")
    (folder / "inner").rename(package / "my_robot_controller" / "my_robot_controller")
