"""draw_circle.py climbs up to a file of another student's."""

from pathlib import Path


def make(package: Path) -> None:
    """Put the link in the place of the node's file."""
    file = package / "my_robot_controller" / "draw_circle.py"
    file.unlink()
    file.symlink_to("../" * 12 + "home/other/student/submission.txt")
