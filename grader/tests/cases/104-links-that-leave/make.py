"""The node's file and two other files are relative or absolute links to files outside the package."""
from pathlib import Path


def make(folder: Path) -> None:
    package = folder / "my_robot_controller"
    module = package / "my_robot_controller" / "draw_circle.py"
    module.rename(folder / "draw_circle.py")
    module.symlink_to("../../draw_circle.py")
    (package / "my_robot_controller" / "notes.py").symlink_to("../../../../../../../etc/hostname")
    (package / "resource" / "secrets").symlink_to("/etc/passwd")
