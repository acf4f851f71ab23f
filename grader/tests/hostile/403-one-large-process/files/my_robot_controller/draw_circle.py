"""The node allocates more memory than the limit."""

import mmap


def main():
    print("TRA" "CE", len(mmap.mmap(-1, 5 << 30)))
