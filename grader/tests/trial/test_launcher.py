from __future__ import annotations

import io
import json
import signal
import subprocess
import tarfile
from typing import TYPE_CHECKING

import grader.trial
from grader.tests.in_ros import HANG_S

if TYPE_CHECKING:
    from pathlib import Path

    from grader.tests.in_ros import InRos

SCRIPT = """#!/usr/bin/env python3
import signal
print(signal.getsignal(signal.SIGINT) is signal.default_int_handler, signal.pthread_sigmask(signal.SIG_BLOCK, ()))
"""


def deaf_to_ctrl_c() -> None:
    """As a shell leaves a job that it starts in the background."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})


def test_a_node_hears_ctrl_c_though_its_grader_does_not(in_ros: InRos, tmp_path: Path) -> None:
    script = tmp_path / "node"
    script.write_text(SCRIPT, "utf-8")
    tree = io.BytesIO()
    tarfile.open(fileobj=tree, mode="w").close()
    order = {"script": str(script), "argv": [], "python_path": [], "env": {}, "install": str(tmp_path / "install")}
    done = subprocess.run(
        [in_ros.here.python, f"{grader.trial.__path__[0]}/launcher.py"],
        input=json.dumps(order).encode() + b"\n" + tree.getvalue(),
        env=in_ros.environment(),
        capture_output=True,
        preexec_fn=deaf_to_ctrl_c,
        timeout=HANG_S,
        check=False,
    )
    assert done.stdout.rpartition(b"ready\n")[2] == b"True set()\n", done.stderr
