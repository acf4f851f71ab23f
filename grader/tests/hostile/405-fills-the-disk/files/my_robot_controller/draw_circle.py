"""The node fills the disk."""

import os


def main():
    for count in range(8):
        with open(f"/tmp/hostile-405-{count}", "wb") as file:
            file.write(bytes(80 << 20))
    print("TRA" "CE", sum(os.path.getsize(f"/tmp/hostile-405-{count}") for count in range(8)))
