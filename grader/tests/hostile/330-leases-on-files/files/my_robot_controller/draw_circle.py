"""The node takes leases on files of the user who grades."""

import fcntl
import os
import sys


def main():
    files = {getattr(module, "__file__", None) for module in [*sys.modules.values()]}
    leased = 0
    for file in filter(os.path.isfile, filter(None, files)):
        with open(file, "rb") as opened:
            try:
                fcntl.fcntl(opened, fcntl.F_SETLEASE, fcntl.F_WRLCK)
            except OSError:
                continue
            leased += 1
            # Without the sandbox, the grader must not wait.
            fcntl.fcntl(opened, fcntl.F_SETLEASE, fcntl.F_UNLCK)
    print("TRA" "CE" if leased else "no leases")
