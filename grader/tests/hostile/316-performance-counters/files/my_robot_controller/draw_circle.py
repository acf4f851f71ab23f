"""The node opens performance counters of other processes."""

import ctypes


def main():
    call = ctypes.CDLL(None, use_errno=True).syscall
    attributes = ctypes.create_string_buffer(bytes([1, 0, 0, 0, 128, 0, 0, 0, 9]), 128)
    attributes[40] = 0x61
    if call(298, attributes, 0, -1, -1, 0) >= 0:
        print("TRA" "CE")
