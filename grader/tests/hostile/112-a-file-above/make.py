"""draw_circle.py is a relative link to a file of another student."""

from pathlib import Path


def make(package: Path) -> None:
    """Replace the file of the node by the link."""
    file = package / "my_robot_controller" / "draw_circle.py"
    file.unlink()
    file.symlink_to("../" * 12 + "home/other/student/submission.txt")
