"""The node becomes root in its own namespace, where the kernel has the most vulnerabilities."""

import ctypes


def main():
    call = ctypes.CDLL(None, use_errno=True).syscall
    import os

    # In a new process, because a process with threads is not allowed to.
    if os.fork() == 0:
        if call(272, 0x10000000) == 0:
            print("TRA" "CE", flush=True)
        os._exit(0)
    os.wait()
