"""It makes files that lie in memory and on no disk."""

import ctypes


def main():
    call = ctypes.CDLL(None, use_errno=True).syscall
    if call(319, b"hostile", 0) >= 0:
        print("TRA" "CE")
