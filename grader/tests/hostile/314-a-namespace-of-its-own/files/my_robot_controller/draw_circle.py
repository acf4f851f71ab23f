"""It makes itself root in a namespace of its own, where most holes are."""

import ctypes


def main():
    call = ctypes.CDLL(None, use_errno=True).syscall
    import os

    # Alone: a process with threads may not.
    if os.fork() == 0:
        if call(272, 0x10000000) == 0:
            print("TRA" "CE", flush=True)
        os._exit(0)
    os.wait()
