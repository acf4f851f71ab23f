"""A process of setup.py keeps the pipes of setup.py open, and kills the process that it was forked from."""

import os
import signal
import sys

print("TRA" "CE of a kept pipe", file=sys.stderr, flush=True)
parent = os.getppid()
if os.fork() == 0:
    os.setsid()
    if os.fork() == 0:
        os.execv("/bin/sh", ["hostile-628", "-c", "sleep 100; true"])
    os._exit(0)
os.wait()
os.kill(parent, signal.SIGKILL)
