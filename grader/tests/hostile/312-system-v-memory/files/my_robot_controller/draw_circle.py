"""The node allocates shared memory that no limit counts and that stays when its process ends."""

import ctypes


def main():
    call = ctypes.CDLL(None, use_errno=True).syscall
    if call(29, 0x311, 64 << 20, 0o1600) >= 0:
        print("TRA" "CE")
