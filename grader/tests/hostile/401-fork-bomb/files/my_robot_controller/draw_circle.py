"""The node keeps starting processes."""

import os


def main():
    for count in range(1500):
        try:
            os.posix_spawn("/bin/sleep", ["sleep", "20"], {})
        except OSError as error:
            print("ended at", count, error)
            return
    print("TRA" "CE 1500 processes")
