"""Names with blanks, line breaks, and bytes that are not UTF-8, beside a right solution."""
import os
from pathlib import Path


def make(folder: Path) -> None:
    package = folder / "my_robot_controller"
    module = package / "my_robot_controller"
    (module / "draw circle (copy).py").write_text("print('old')")
    (module / "line\r\nbreak.py").write_text("")
    (package / "Übung 3.txt").write_text("notes")
    for name in (b"caf\xe9.txt", b"\xff\xfe.py"):
        Path(os.fsdecode(os.fsencode(module) + b"/" + name)).write_bytes(b"\xff")
