"""What hostile nodes and conductors attempt with the fork servers, and with the forks of other submissions."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from grader.ros import installation, underlay
from grader.sandbox import bubblewrap
from grader.tests.observed_host import Host, readable_by_others

if TYPE_CHECKING:
    from collections.abc import Iterator

pytestmark = pytest.mark.skipif(not bubblewrap.usable(), reason="there is no sandbox here")
as_user = pytest.mark.skipif(not readable_by_others(Path(__file__)), reason="other users cannot read this folder")

TRIALS = """
import io, sys, tarfile, threading
from grader.ros.installation import find_ros
from grader.ros.underlay import with_turtlesim
from grader.trial.recording import Pose
from grader.trial.trial import Plan, Trial

def run(script, duration_s, begun=None):
    tree = io.BytesIO()
    with tarfile.open(fileobj=tree, mode="w") as archive:
        member = tarfile.TarInfo("package/lib/package/node")
        script = "#!/usr/bin/env python3\\n" + script
        member.mode, member.size = 0o755, len(script.encode())
        archive.addfile(member, io.BytesIO(script.encode()))
    plan = Plan("wall", Pose(5.5, 5.5, 0.0), None, duration_s)
    with Trial(plan, with_turtlesim(find_ros()), in_cell=True) as trial:
        trial.await_ready()
        return trial.run("package", "node", tree.getvalue()).stdout.text
"""
"""A program begins with this text. It can then run a script as a node of a trial in wall time."""
IN_TRANSIT = """
import socket, time
kept, count = [], 0
try:
    while True:
        kept += socket.socketpair(socket.AF_UNIX, socket.SOCK_DGRAM)
        try:
            while True:
                socket.send_fds(kept[-2], [b"x"], [0] * 100, socket.MSG_DONTWAIT)
                count += 100
        except BlockingIOError:
            pass
except OSError as error:
    print(count > 1000, error.errno, flush=True)
time.sleep(6)
"""


@pytest.fixture
def folder() -> Iterator[Path]:
    """Return a new folder that other users can read, unlike pytest's own folders."""
    with tempfile.TemporaryDirectory(prefix="forks-", ignore_cleanup_errors=True) as made:
        Path(made).chmod(0o755)
        yield Path(made)


def beside(hostile: str, folder: Path, limits: str = "") -> str:
    """Return the output of a hostile node, and of honest ones that start while the hostile node runs."""
    code = f"""{TRIALS}
{limits}
results = []
hostile = threading.Thread(target=lambda: results.append(run({hostile!r}, 4.0)))
hostile.start()
hostile.join(3.0)
honest = [run("print('honest')", 0.1) for _ in range(2)]
hostile.join()
print(*results, *honest, sep="", end="")
"""
    host = Host(folder, underlay.ensure(installation.find_ros()), as_user=True)
    (host.work / "program.py").write_text(code, "utf-8")
    done = host.run([sys.executable, "/tmp/work/program.py"])
    assert done.exit_code == 0, done.stderr
    return done.stdout


@as_user
def test_a_node_that_fills_the_sockets_of_its_user_with_descriptors_does_not_stop_other_trials(folder: Path) -> None:
    limits = "import resource; resource.setrlimit(resource.RLIMIT_NOFILE, (1024, resource.getrlimit(7)[1]))"
    assert beside(IN_TRANSIT, folder, limits) == "True 109\nhonest\nhonest\n"
