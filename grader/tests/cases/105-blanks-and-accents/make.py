"""A correct solution, with files whose names contain spaces, accents and special characters of the shell."""

from pathlib import Path


def make(folder: Path) -> None:
    package = folder / "my_robot_controller"
    module = package / "my_robot_controller"
    (module / "draw circle (copy).py").write_text("print('old')")
    (package / "Übung 3.txt").write_text("notes")
    (package / "-rf *; $HOME").write_text("")
