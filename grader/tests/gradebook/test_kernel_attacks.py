"""nbgrader stops kernels that attack it, reports the reason, needs little memory, and can save the notebook."""

from __future__ import annotations

import resource
import tempfile
import time
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_notebook
from traitlets.config import Configurable

from grader.gradebook.cell_outputs import MOST_OUTPUT, TOO_MUCH
from grader.gradebook.confined_autograde import ConfinedExecute
from grader.sandbox import bubblewrap

if TYPE_CHECKING:
    from nbformat import NotebookNode

pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")
MORE_KIB = 512 * 1024
"""The maximum growth of nbgrader's process during an attack."""
NO_MESSAGE = "The kernel sent data that is not a Jupyter message."

COMM = "from comm import create_comm\n"
SEND = """\
import json
from IPython import get_ipython
kernel = get_ipython().kernel
def send(kind, content, **more):
    kernel.session.send(kernel.iopub_socket, kind, content, parent=kernel.get_parent(), **more)
"""
PLAIN = "kernel.session.pack = lambda what: json.dumps(what, default=str).encode()\n"

ATTACKS = {
    "large widgets": (
        COMM + "for _ in range(12):\n    create_comm(target_name='jupyter.widget', buffers=[bytes(120 << 20)],\n"
        "        data={'state': {}, 'buffer_paths': [['a']]})",
        "The kernel sent a message of more than 4 MiB.",
    ),
    "many widgets": (
        COMM + "for n in range(12):\n    create_comm(target_name='jupyter.widget', buffers=[bytes([n]) * (3 << 20)],\n"
        "        data={'state': {}, 'buffer_paths': [['a']]})",
        "The kernel sent more than 16 MiB in all its messages.",
    ),
    "messages without end": (
        SEND + "while True:\n    send('comm_msg', {'comm_id': 'a', 'data': {}})",
        "The kernel sent more than 10000 messages.",
    ),
    "lists without end": (
        SEND
        + "for n in range(9):\n    send('comm_msg', {'comm_id': str(n), 'data': {'state': {'a': [[]] * 300_000}}})",
        "The kernel sent more than 1000000 values in all its messages.",
    ),
    "a deep list": (
        SEND + "deep = []\nfor _ in range(200):\n    deep = [deep]\nsend('comm_msg', {'comm_id': 'a', 'data': deep})",
        "The kernel sent a message with objects nested more than 50 levels deep.",
    ),
    "half a letter": (
        SEND + PLAIN + "send('stream', {'name': 'stdout', 'text': '\\ud800'})",
        NO_MESSAGE,
    ),
    "not a number": (
        SEND + PLAIN + "send('comm_msg', {'data': float('nan')})",
        NO_MESSAGE,
    ),
    "files without end": (
        "for n in range(300_000):\n    open(f'/tmp/{n}', 'w').close()\nimport time; time.sleep(60)",
        "The notebook exceeded its limit on files.",
    ),
    "memory without end": (
        "kept = [bytearray(b'x') * (200 << 20) for _ in range(15)]\nimport time; time.sleep(60)",
        "The notebook exceeded its limit on memory.",
    ),
    "output without keys": (SEND + "send('stream', {})", "The kernel sent messages that nbgrader could not process."),
    "a display with a list as its id": (
        SEND + "send('display_data', {'data': {}, 'metadata': {}, 'transient': {'display_id': [1]}})",
        "The kernel sent messages that nbgrader could not process.",
    ),
    "an output of another kind": (
        SEND + "send('execute_result', {'data': 7, 'metadata': [], 'execution_count': 'x'})",
        "The kernel sent messages that nbgrader could not process.",
    ),
    "a change that is none": (
        SEND + "about = {'metadata': {}, 'transient': {'display_id': 'a'}}\n"
        "send('display_data', {'data': {'text/plain': ''}, **about})\n"
        "send('update_display_data', {'data': {'text/plain': 7}, **about})",
        "The kernel sent messages that nbgrader could not process.",
    ),
    "its own bridge": ("import os, signal\nos.kill(os.getppid(), signal.SIGKILL)", "The kernel died."),
}
"""Maps a name to the source of a cell, and the reason why no cell runs after it."""
SAMPLE = ("large widgets", "messages without end", "files without end", "output without keys")

MANY_CHANGED = (
    SEND
    + "about = {'metadata': {}, 'transient': {'display_id': 'a'}}\n"
    + "for _ in range(300):\n    send('display_data', {'data': {'text/plain': ''}, **about})\n"
    + "send('update_display_data', {'data': {'text/plain': 'x' * 3_000_000}, **about})"
)
"""The source of messages that change outputs to a total size of about a gigabyte."""


class Application(Configurable):
    """The parts of nbgrader's application that a step uses."""

    coursedir: Any = None


def executed(folder: Path, *sources: str, **limits: int) -> NotebookNode:
    """Run autograde's step on a notebook with these cells. Assert that the result can be written and read."""
    application = Application()
    application.coursedir = SimpleNamespace(format_path=lambda *_: str(folder), submitted_directory="submitted")
    # On a busy machine, an attack may take longer than a student's cell may.
    step = ConfinedExecute(parent=Configurable(parent=application), **{"cell_s": 300, **limits})
    notebook = new_notebook(cells=[new_code_cell(source) for source in sources])  # type: ignore[no-untyped-call]
    about = {"student": "mallory", "assignment": "01"}
    done, _ = step.preprocess(notebook, {"nbgrader": about, "metadata": {"path": str(folder)}})
    written = nbformat.writes(done).encode()  # type: ignore[no-untyped-call]
    assert len(written) < 2 * MOST_OUTPUT
    nbformat.validate(nbformat.reads(written.decode(), as_version=4))  # type: ignore[no-untyped-call]
    return done


def said(cell: NotebookNode) -> str:
    """Return the text of the outputs of a cell."""
    return "".join(str(output.get("evalue") or output.get("text")) for output in cell.outputs)


def names(folder: str) -> set[str]:
    """Return the names of the files and folders in a folder of this machine."""
    return {path.name for path in Path(folder).iterdir()}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=() if name in SAMPLE else pytest.mark.exhaustive) for name in ATTACKS]
)
def test_a_kernel_that_attacks_is_ended_with_a_reason(name: str, tmp_path: Path) -> None:
    source, why = ATTACKS[name]
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    first, attacking, later = executed(tmp_path, "print(2 + 2)", source, "print('later')").cells
    assert (said(first), said(attacking)[: len(why)], said(later)[: len(why)]) == ("4\n", why, why)
    assert later.outputs[0].ename == "NotRun"
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < MORE_KIB


def test_one_message_that_changes_many_outputs_does_not_make_a_large_notebook(tmp_path: Path) -> None:
    attacking, later = executed(tmp_path, MANY_CHANGED, "print('later')").cells
    assert (said(attacking), said(later)) == (TOO_MUCH, TOO_MUCH)


def test_outputs_that_are_read_slowly_do_not_end_the_notebook(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    process = ConfinedExecute.process_message

    def slowly(*arguments: Any) -> Any:  # noqa: ANN401
        time.sleep(0.8)
        return process(*arguments)

    monkeypatch.setattr(ConfinedExecute, "process_message", slowly)
    shows = "for n in range(7):\n    display(n)"
    (cell,) = executed(tmp_path, shows).cells
    assert [output.data["text/plain"] for output in cell.outputs] == [str(number) for number in range(7)]


def test_cells_that_sleep_have_one_time_limit_together(tmp_path: Path) -> None:
    sleeps = "import time; time.sleep(600)"
    *_, last = executed(tmp_path, sleeps, sleeps, "print('later')", notebook_s=1).cells
    assert said(last) == "The cells of the notebook took longer than 1 s."


def test_a_kernel_can_only_write_to_its_own_disks(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    # Use a folder that no kernel of another test uses.
    with tempfile.TemporaryDirectory(prefix="k") as own:
        monkeypatch.setattr(tempfile, "tempdir", own)
        assert_writes_only_to_own_disks(tmp_path)
        assert names(own) == set()


def assert_writes_only_to_own_disks(folder: Path) -> None:
    code = """
for line in open('/proc/self/mountinfo'):
    before, _, after = line.partition(' - ')
    place, options, kind = before.split()[4], before.split()[5], after.split()[0]
    if 'rw' in options.split(',') and kind not in ('proc', 'devpts', 'mqueue', 'devtmpfs'):
        print(place, kind, 'size=' in after)
"""
    fills = "with open('/tmp/large', 'wb') as file:\n    for _ in range(1150):\n        file.write(bytes(1 << 20))"
    mounts, filled = executed(folder, code, fills).cells
    assert sorted(said(mounts).splitlines()) == ["/dev/shm tmpfs True", "/tmp tmpfs True", "/ws tmpfs True"]
    assert "No space left on device" in said(filled) or "File too large" in said(filled)
