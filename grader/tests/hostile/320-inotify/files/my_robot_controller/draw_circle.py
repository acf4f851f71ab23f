"""The node uses up the inotify instances of its user."""

import ctypes


def main():
    libc = ctypes.CDLL(None, use_errno=True)
    made = sum(libc.inotify_init() >= 0 for _ in range(100))
    print("TRA" "CE 100 instances" if made == 100 else made)
