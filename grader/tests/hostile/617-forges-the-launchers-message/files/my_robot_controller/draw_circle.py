"""The node repeats the launcher's message `ready` and closes all its files."""

import os


def main():
    os.write(1, b"\x00ready 1\n" * 100)
    os.write(2, b"TRA" b"CE of a second start\n")
    os.closerange(0, 1000)
