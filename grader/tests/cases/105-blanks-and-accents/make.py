"""Names with blanks, accents and signs of the shell, beside a right solution."""

from pathlib import Path


def make(folder: Path) -> None:
    package = folder / "my_robot_controller"
    module = package / "my_robot_controller"
    (module / "draw circle (copy).py").write_text("print('old')")
    (package / "Übung 3.txt").write_text("notes")
    (package / "-rf *; $HOME").write_text("")
