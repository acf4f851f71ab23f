"""Run cells in the course's kernel as Jupyter starts it, in a terminal without ROS 2."""

from __future__ import annotations

import os
import signal
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.exercise.model import course_folder
from grader.notebook import guardian
from grader.tests.notebook.kernels import Notebook, open_notebook
from grader.tests.waiting import until

if TYPE_CHECKING:
    from collections.abc import Iterator

STEP = "03-circle-publisher"
NODE = "my_robot_controller/my_robot_controller/draw_circle.py"
SOLUTION = (course_folder().parent / "solutions" / STEP / NODE).read_text("utf-8")
START = (course_folder().parent / "exercises" / STEP / NODE).read_text("utf-8")
BEGIN = f"%load_ext grader.notebook\n%step {STEP}"


@pytest.fixture
def home(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", os.environ.get("XDG_CACHE_HOME") or str(Path.home() / ".cache"))
    monkeypatch.setenv("HOME", str(tmp_path))
    for name in ("AMENT_PREFIX_PATH", "LD_LIBRARY_PATH", "ROS_DISTRO", "NBGRADER_EXECUTION", "XDG_STATE_HOME"):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


@pytest.fixture
def folder(home: Path) -> Path:
    (home / "step").mkdir()
    return home / "step"


@pytest.fixture
def notebook(folder: Path) -> Iterator[Notebook]:
    with open_notebook(folder) as opened:
        yield opened


def marked_processes(mark: str) -> set[int]:
    """Return the processes that have the mark of a notebook in their environment."""
    found = set()
    for entry in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            if f"{guardian.VARIABLE}={mark}".encode() in (entry / "environ").read_bytes().split(b"\0"):
                found.add(int(entry.name))
    return found


def test_from_the_first_cell_to_full_marks(notebook: Notebook, folder: Path) -> None:
    assert "Draw a circle" in notebook.run(BEGIN)
    assert (folder / NODE).read_text() == START

    # ROS 2 is available in the kernel and its children without sourcing anything.
    assert notebook.run("import rclpy; rclpy.ok()") == "False"
    assert "float64 x" in notebook.run("ros2 interface show geometry_msgs/msg/Vector3")

    assert notebook.run("%%node draw_circle.py\n" + SOLUTION) == f"Written: {NODE}\n"
    assert (folder / NODE).read_text() == SOLUTION

    said = notebook.run('verdict = check("03-circle-publisher")\nverdict')
    assert "Passed: 100 of 100 points." in said
    result = next(output for output in notebook.outputs if output.output_type == "execute_result")
    assert result.data["text/html"].count("<svg") >= 3
    assert "<script" not in result.data["text/html"]
    # The next cell calls check again, and nothing is graded twice.
    assert notebook.run("check() is verdict") == "True"
    assert notebook.run('check().points("circle")') == "✓ The turtle drives a circle  25/25\n25.0"
    assert "has no check 'round'" in notebook.run('check().points("round")')


def test_the_canvas_moves_below_the_cell_and_the_simulator_ends_with_the_kernel(
    notebook: Notebook, folder: Path
) -> None:
    notebook.run(BEGIN)
    (folder / NODE).write_text(SOLUTION)
    said = notebook.run(
        "from IPython.utils.capture import capture_output\n"
        "with simulator() as sim:\n"
        "    before = sim.picture()\n"
        "    sim.start('draw_circle')\n"
        "    listed = ''\n"
        "    while '/turtlesim' not in listed:\n"  # the command does not wait for a node that sends nothing for seconds
        "        with capture_output(display=False) as captured:\n"
        # Without this option, the real command would start a daemon.
        "            %ros2 node list --no-daemon\n"
        "        listed = captured.stdout\n"
        "    print(listed)\n"
        "    while sim.picture() == before: sim.wait(0.1)"
    )
    assert "/turtlesim" in said
    pictures = [output for output in notebook.outputs if "image/png" in output.get("data", {})]
    assert len(pictures) == 1
    assert notebook.run("sim.picture() == before") == "False"

    mark = notebook.run(f"import os; print(os.environ[{guardian.VARIABLE!r}])").strip()
    assert marked_processes(mark) == set()  # the simulator ended with the `with` statement
    notebook.run("sim = simulator(); sim.__enter__(); sim.start('draw_circle')")
    notebook.run("import subprocess; subprocess.Popen(['setsid', 'sleep', '1000'])")
    until(lambda: len(marked_processes(mark)) >= 3)  # a process has no environment while exec is in progress
    os.kill(notebook.pid, signal.SIGKILL)
    until(lambda: not marked_processes(mark))


def test_no_work_of_a_student_is_lost(notebook: Notebook, folder: Path, home: Path) -> None:
    own = home / "ros2_ws" / "src" / "my_robot_controller" / "my_robot_controller"
    own.mkdir(parents=True)
    (own / "draw_circle.py").write_text("# my own, from the workspace\n")
    notebook.run(BEGIN)
    assert (folder / NODE).read_text() == "# my own, from the workspace\n"
    assert (folder / "my_robot_controller" / "package.xml").is_file()  # the other files come from the starting point

    # The released cell does not undo the work. A cell that was changed replaces the file and keeps a copy.
    assert "stays unchanged" in notebook.run("%%node draw_circle.py\n" + START)
    assert (folder / NODE).read_text() == "# my own, from the workspace\n"
    assert "kept in .kept/draw_circle-1.py" in notebook.run("%%node draw_circle.py\n# from the cell")
    assert (folder / ".kept" / "draw_circle-1.py").read_text() == "# my own, from the workspace\n"
    assert notebook.run("%%node draw_circle.py\n# from the cell, again") == f"Written: {NODE}\n"


def test_a_mistake_is_reported_in_one_sentence(notebook: Notebook) -> None:
    assert "Run the first cell" in notebook.run("%load_ext grader.notebook\ncheck()")
    assert "there is no exercise '33'" in notebook.run("%step 33")
    notebook.run(f"%step {STEP}")
    assert "needs the name of a Python file" in notebook.run("%%node ../../x.py\npass")
    assert "has no nothing.py" in notebook.run("with simulator() as sim:\n    sim.run('nothing')")
    assert notebook.outputs[-1].traceback == [notebook.outputs[-1].evalue]


def test_under_nbgrader_it_is_quiet(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NBGRADER_EXECUTION", "autograde")
    with open_notebook(folder) as notebook:
        assert notebook.run(BEGIN) == ""
        assert notebook.run("ros2 topic list") == ""
        (folder / NODE).write_text("# as the student left it\n")
        assert notebook.run("%%node draw_circle.py\n# from a cell") == ""
        assert (folder / NODE).read_text() == "# as the student left it\n"
        assert notebook.run("with simulator() as sim:\n    sim.run('draw_circle')") == ""
