"""setup.py starts many large processes."""

import os
import time

for _count in range(6):
    if os.fork() == 0:
        block = bytearray(450 << 20)
        time.sleep(5)
        os._exit(0)
time.sleep(2)
print("TRA" "CE 2.7 GB")
