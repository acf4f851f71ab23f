"""setup.py uses up the pipe pages of its user while other submissions are graded."""

import fcntl
import os

_made = 0
for _ in range(40):
    _pipe, _ = os.pipe()
    try:
        fcntl.fcntl(_pipe, fcntl.F_SETPIPE_SZ, 1 << 20)
    except OSError:
        break
    _made += 1
if _made == 40:
    print("TRA" "CE 40 pipes of a megabyte")
