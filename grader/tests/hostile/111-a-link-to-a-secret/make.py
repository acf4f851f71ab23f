"""draw_circle.py points to a file of the caller's."""

from pathlib import Path


def make(package: Path) -> None:
    """Put the link in the place of the node's file."""
    file = package / "my_robot_controller" / "draw_circle.py"
    file.unlink()
    file.symlink_to("/home/caller/.secret")
