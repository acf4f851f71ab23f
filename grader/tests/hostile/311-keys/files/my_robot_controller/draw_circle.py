"""The node leaves a key in the caller's session."""

import ctypes


def main():
    call = ctypes.CDLL(None, use_errno=True).syscall
    serial = call(248, b"user", b"hostile", b"secret", 6, -3)
    if serial > 0:
        print("TRA" "CE", serial)
