"""draw_circle.py is a link to a file of the caller."""

from pathlib import Path


def make(package: Path) -> None:
    """Replace the file of the node by the link."""
    file = package / "my_robot_controller" / "draw_circle.py"
    file.unlink()
    file.symlink_to("/home/caller/.secret")
