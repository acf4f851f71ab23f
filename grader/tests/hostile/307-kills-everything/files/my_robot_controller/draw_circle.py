"""It ends every process that it may."""

import os
import signal


def main():
    os.kill(-1, signal.SIGKILL)
