"""The node flushes the machine's disks again and again, so that all other programs wait for them."""

import ctypes
import os

SYNCFS = 306


def main():
    libc = ctypes.CDLL(None, use_errno=True)
    machine = os.open("/usr", os.O_RDONLY)
    written = sum(libc.syscall(SYNCFS, machine) == 0 for _ in range(20))
    print("TRA" "CE 20 times" if written == 20 else written)
