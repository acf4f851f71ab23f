"""The node watches folders that other cells read too, without inotify."""

import fcntl
import os


def main():
    try:
        fcntl.fcntl(os.open("/usr/lib", os.O_RDONLY), fcntl.F_NOTIFY, fcntl.DN_ACCESS | fcntl.DN_MULTISHOT)
    except OSError as error:
        print(error)
    else:
        print("TRA" "CE")
