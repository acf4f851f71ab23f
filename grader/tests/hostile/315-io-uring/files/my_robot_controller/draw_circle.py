"""The node uses io_uring to avoid the filter of system calls."""

import ctypes


def main():
    call = ctypes.CDLL(None, use_errno=True).syscall
    parameters = ctypes.create_string_buffer(120)
    if call(425, 1, parameters) >= 0:
        print("TRA" "CE")
