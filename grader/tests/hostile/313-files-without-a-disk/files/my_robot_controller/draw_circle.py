"""The node creates files in memory that are not on a disk."""

import ctypes


def main():
    call = ctypes.CDLL(None, use_errno=True).syscall
    if call(319, b"hostile", 0) >= 0:
        print("TRA" "CE")
