"""setup.py stops the process that it was forked from, and colcon."""

import os
import signal
import sys

print("TRA" "CE of a stop", file=sys.stderr, flush=True)
for process in filter(str.isdigit, os.listdir("/proc")):
    if int(process) not in (1, os.getpid()):
        try:
            os.kill(int(process), signal.SIGSTOP)
        except OSError:
            pass
os.kill(os.getpid(), signal.SIGSTOP)
