"""The node's file is in Latin-1, as an old editor saves it. Python cannot read the file."""

from pathlib import Path


def make(folder: Path) -> None:
    module = folder / "my_robot_controller" / "my_robot_controller" / "draw_circle.py"
    text = module.read_text("utf-8").replace("Draw circle node has been started", "Der Kreis läuft")
    module.write_bytes(text.encode("latin-1"))
