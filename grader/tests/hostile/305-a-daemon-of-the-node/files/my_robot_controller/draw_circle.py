"""The node leaves a process behind that waits."""

import os
import time


def main():
    if os.fork() == 0:
        os.setsid()
        if os.fork() == 0:
            for fd in (0, 1, 2):
                os.close(fd)
            os.execv("/bin/sh", ["hostile-305", "-c", "sleep 600; true"])
        os._exit(0)
    print("TRA" "CE of a daemon", flush=True)
    time.sleep(0.5)
