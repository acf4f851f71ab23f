"""The node and its child processes ignore all signals."""

import os
import signal
import time


def main():
    for number in range(1, 32):
        if number not in (signal.SIGKILL, signal.SIGSTOP, signal.SIGCHLD):
            signal.signal(number, signal.SIG_IGN)
    for _ in range(20):
        if os.fork() == 0:
            os.setsid()
            time.sleep(120)
    print("TRA" "CE of silence", flush=True)
    while True:
        time.sleep(1)
