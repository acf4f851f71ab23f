"""It makes itself root in a namespace of its own, where most holes are."""

import ctypes


def main():
    call = ctypes.CDLL(None, use_errno=True).syscall
    if call(272, 0x10000000) == 0:
        print("TRA" "CE")
