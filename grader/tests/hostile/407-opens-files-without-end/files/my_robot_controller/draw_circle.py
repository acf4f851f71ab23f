"""It opens files without end."""

import os


def main():
    for _ in range(20_000):
        os.open("/dev/null", os.O_RDONLY)
    print("TRA" "CE 20000 descriptors")
