"""The node uses up the pipe pages of its user, so that other pipes are small."""

import fcntl
import os


def main():
    for count in range(40):
        reads, _writes = os.pipe()
        try:
            fcntl.fcntl(reads, fcntl.F_SETPIPE_SZ, 1 << 20)
        except OSError as error:
            print("ended at", count, error)
            return
    print("TRA" "CE 40 pipes of a megabyte")
