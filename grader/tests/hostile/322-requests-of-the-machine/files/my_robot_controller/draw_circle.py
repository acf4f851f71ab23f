"""The node uses up the asynchronous I/O requests that all users of the machine share."""

import ctypes


def main():
    call, context = ctypes.CDLL(None, use_errno=True).syscall, ctypes.c_ulong()
    if call(206, 1000, ctypes.byref(context)) == 0:
        print("TRA" "CE of 1000 requests")
