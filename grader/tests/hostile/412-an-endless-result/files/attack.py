"""setup.py installs too many files to read."""

from pathlib import Path

folder = Path("../../install/my_robot_controller/share/many")
folder.mkdir(parents=True, exist_ok=True)
for _count in range(30_000):
    (folder / str(_count)).write_text("")
