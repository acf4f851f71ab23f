"""The node reads the memory of another process in one call."""

import ctypes


def main():
    call = ctypes.CDLL(None, use_errno=True).syscall
    import os

    child = os.fork()
    if child == 0:
        import signal

        signal.pause()
    word = ctypes.create_string_buffer(b"12345678")
    piece = (ctypes.c_void_p * 2)(ctypes.addressof(word), 8)
    if call(310, child, piece, 1, piece, 1, 0) == 8:
        print("TRA" "CE")
    os.kill(child, 9)
