"""The node sends SIGSTOP to itself, so it does not react to Ctrl-C."""

import os
import signal


def main():
    print("TRA" "CE of a stop", flush=True)
    os.kill(os.getpid(), signal.SIGSTOP)
