"""A student hands in a whole workspace, with another package, colcon's files of an older state and a virtual environment."""
from pathlib import Path


def make(folder: Path) -> None:
    package = folder / "my_robot_controller"
    (folder / "src").mkdir()
    package.rename(folder / "src" / "my_robot_controller")
    for left in ("build/my_robot_controller", "install/my_robot_controller/share/my_robot_controller", "log", ".git"):
        (folder / left).mkdir(parents=True)
        (folder / left / "package.xml").write_text("<package>old</package>")
        (folder / left / "setup.py").write_text("raise SystemExit('old')")
    another = folder / "src" / "another_package"
    another.mkdir()
    (another / "package.xml").write_text("<package><name>another_package</name></package>")
    (another / "setup.py").write_text("raise SystemExit('another')")
    environment = folder / "venv" / "lib" / "python3.12" / "site-packages" / "other"
    environment.mkdir(parents=True)
    (folder / "venv" / "pyvenv.cfg").write_text("home = /usr/bin")
    (environment / "setup.py").write_text("")
