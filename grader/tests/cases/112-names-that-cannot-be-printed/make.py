"""A correct solution, with files whose names contain line breaks and bytes that are not UTF-8."""

import os
from pathlib import Path


def make(folder: Path) -> None:
    module = folder / "my_robot_controller" / "my_robot_controller"
    for name in (b"line\r\nbreak.py", b"caf\xe9.txt", b"\xff\xfe.py"):
        Path(os.fsdecode(os.fsencode(module) + b"/" + name)).write_bytes(b"\xff")
