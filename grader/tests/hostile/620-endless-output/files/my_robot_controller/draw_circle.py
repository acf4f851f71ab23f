"""The node keeps printing."""

import os


def main():
    os.write(1, b"TRA" b"CE of noise\n")
    for _ in range(3000):
        os.write(1, b"x" * 100_000)
