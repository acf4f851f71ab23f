from __future__ import annotations

from pathlib import Path

from grader.sandbox.descendants import kill_descendants
from grader.tests.trial.program import python
from grader.tests.waiting import until

LEAVES_A_THREAD = """
import ctypes, os, signal, threading, time
child = os.fork()
if child == 0:
    threading.Thread(target=time.sleep, args=(600,)).start()
    ctypes.CDLL(None).pthread_exit(None)
print("ready", flush=True)
print(child, flush=True)
signal.pause()
"""


def test_a_process_whose_main_thread_alone_has_exited_is_killed() -> None:
    with python(LEAVES_A_THREAD) as process:
        assert process.stdout is not None
        child = Path("/proc") / process.stdout.readline().strip()
        until(lambda: (child / "stat").read_text().split()[2] == "Z")
        assert len(list((child / "task").iterdir())) == 2
        kill_descendants(process.pid)
        assert len(list((child / "task").iterdir())) == 1
