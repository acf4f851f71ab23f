"""The node keeps creating empty files."""

import os
import time


def main():
    os.makedirs("/tmp/hostile-406", exist_ok=True)
    for count in range(200_000):
        os.close(os.open(f"/tmp/hostile-406/{count}", os.O_CREAT | os.O_WRONLY))
    time.sleep(5)
    print("TRA" "CE 200000 files")
