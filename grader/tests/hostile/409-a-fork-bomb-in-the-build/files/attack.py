"""setup.py keeps starting processes."""

import os

for _count in range(1500):
    os.posix_spawn("/bin/sleep", ["sleep", "20"], {})
print("TRA" "CE 1500 processes")
