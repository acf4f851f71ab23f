"""The relay forwards the data from the pipe of a sandbox cell, and exits when the cell or nbgrader exits."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from grader.common.interpreter import interpreter
from grader.gradebook.relay import WHY_FILE, Order
from grader.notebook.frames import packed
from grader.sandbox.bubblewrap import View
from grader.tests.waiting import HANG_S, until

INFO = """{"ip": "SOCKETS", "key": "key", "signature_scheme": "hmac-sha256",
"shell_port": 1, "control_port": 2, "stdin_port": 3, "iopub_port": 4, "hb_port": 5}"""
STAYS = "\nimport time; time.sleep(600)"
NO_MESSAGE = "The kernel sent data that is not a Jupyter message."


class Started:
    """Starts a relay whose cell is a Python process with this code, without a sandbox."""

    def __init__(self, folder: Path, code: str) -> None:
        self.folder = folder
        file = folder / "kernel.json"
        file.write_text(INFO.replace("SOCKETS", str(folder / "socket")))
        env = {"PATH": os.environ["PATH"]}
        Order([sys.executable, "-c", code], env, View(()), False, str(file)).write(folder)  # noqa: FBT003
        start = interpreter("-m", "grader.gradebook.relay", str(folder))
        self.process = subprocess.Popen(start.argv, env=start.env, stdin=subprocess.PIPE)

    def why(self) -> str:
        """Return the reason why the relay stopped the cell."""
        assert self.process.wait(HANG_S) == 0
        file = self.folder / WHY_FILE
        return file.read_text() if file.is_file() else ""


@pytest.mark.parametrize(
    ("sent", "why"),
    [
        (b"\xff" * 100, NO_MESSAGE),
        (b"\0\0\1\xff\xff\xff\xff", "The kernel sent a message of more than 4 MiB."),
        (b"\0\xff\xff", NO_MESSAGE),
        (packed(3, [b"a"]), NO_MESSAGE),
        (packed(3, []), NO_MESSAGE),
        (packed(4, [b"{}"]), NO_MESSAGE),
        (packed(0, [b"<IDS|MSG>", b"0" * 64, b"{}", b"{}", b"{}", b"{}"]), NO_MESSAGE),
    ],
)
def test_data_that_are_not_a_message_end_the_cell_at_once(tmp_path: Path, sent: bytes, why: str) -> None:
    relay = Started(tmp_path, f"import os; os.write(1, {sent!r})" + STAYS)
    assert relay.why() == why


def test_the_relay_ends_with_its_cell(tmp_path: Path) -> None:
    assert Started(tmp_path, "pass").why() == ""


def test_the_relay_waits_for_the_rest_of_a_frame_until_the_cell_ends(tmp_path: Path) -> None:
    assert Started(tmp_path, "import os; os.write(1, bytes(2))").why() == ""


def test_a_relay_ends_with_nbgrader_and_ends_the_cell(tmp_path: Path) -> None:
    relay = Started(tmp_path, f"import os; open({str(tmp_path / 'pid')!r}, 'w').write(str(os.getpid()))" + STAYS)
    file = tmp_path / "pid"
    until(lambda: file.is_file() and bool(file.read_text()))
    assert relay.process.stdin is not None
    relay.process.stdin.close()
    assert relay.why() == ""
    assert not Path(f"/proc/{file.read_text()}").exists()
