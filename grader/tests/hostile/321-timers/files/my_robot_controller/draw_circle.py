"""The node uses up the pending signals and timers of its user."""

import ctypes


def main():
    libc, timer = ctypes.CDLL(None, use_errno=True), ctypes.c_void_p()
    made = 0
    while made < 5000 and libc.timer_create(1, None, ctypes.byref(timer)) == 0:
        made += 1
    print("TRA" "CE 5000 timers" if made == 5000 else made)
