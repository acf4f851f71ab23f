"""A kernel of autograde sees its submission, the course and ROS 2, and no other part of the machine."""

from __future__ import annotations

from typing import TYPE_CHECKING

import nbformat
import pytest
from nbclient import NotebookClient

from grader.exercise.model import course_folder
from grader.gradebook.confined_autograde import ConfinedKernelManager
from grader.sandbox import bubblewrap
from grader.tests.notebook.kernels import Notebook
from grader.tests.waiting import HANG_S

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")


@pytest.fixture
def submission(tmp_path: Path) -> Path:
    folder = tmp_path / "submission"
    (folder / "package").mkdir(parents=True)
    (folder / "package" / "node.py").write_text("mine\n")
    (folder / "ipykernel.py").write_text("raise SystemExit('a student who shadows a library')\n")
    (tmp_path / "secret").write_text("of the instructor")
    (folder / "link").symlink_to(tmp_path / "secret")
    return folder


@pytest.fixture
def notebook(submission: Path) -> Iterator[Notebook]:
    manager = ConfinedKernelManager(submission=str(submission))
    patience = {"timeout": int(HANG_S), "startup_timeout": int(HANG_S)}
    client = NotebookClient(nbformat.v4.new_notebook(), km=manager, allow_errors=True, **patience)  # type: ignore[no-untyped-call]
    with client.setup_kernel(cleanup_kc=True):
        yield Notebook(client)


def test_a_kernel_in_a_cell(notebook: Notebook, submission: Path, tmp_path: Path) -> None:
    assert notebook.run("print(open('package/node.py').read())") == "mine\n\n"
    # A link that leads out of the submission was not copied.
    assert notebook.run("import os; print(sorted(os.listdir()))") == "['ipykernel.py', 'package']\n"
    assert notebook.run(f"print(os.path.exists({str(tmp_path / 'secret')!r}))") == "False\n"
    solutions = course_folder().parent / "solutions"
    assert notebook.run(f"print(os.path.exists({str(solutions)!r}), os.path.exists('/root'))").startswith("False ")
    # Changes stay in the cell.
    assert notebook.run("open('package/node.py', 'w').write('changed')") == "7"
    assert (submission / "package" / "node.py").read_text() == "mine\n"
    # The cell has only its loopback network.
    said = notebook.run("import socket; socket.create_connection(('192.0.2.1', 80), 5)")
    assert "unreachable" in said
    assert "4" in notebook.run("import rclpy; print(2 + 2)")
