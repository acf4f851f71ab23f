"""It asks for more memory than there may be."""

import mmap


def main():
    print("TRA" "CE", len(mmap.mmap(-1, 5 << 30)))
