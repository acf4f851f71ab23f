"""The node's file is in Latin-1, as an old editor saves it: Python does not read it."""
from pathlib import Path


def make(folder: Path) -> None:
    module = folder / "my_robot_controller" / "my_robot_controller" / "draw_circle.py"
    module.write_bytes("# Übung 3: ein Kreis\n".encode("latin-1") + module.read_bytes())
