"""It stops, and no longer hears Ctrl-C."""

import os
import signal


def main():
    print("TRA" "CE of a stop", flush=True)
    os.kill(os.getpid(), signal.SIGSTOP)
