"""The node kills every process that it can."""

import os
import signal


def main():
    os.kill(-1, signal.SIGKILL)
