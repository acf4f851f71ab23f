"""The node creates a file that is larger than the disk."""

import os


def main():
    os.truncate(os.open("/tmp/hostile-408", os.O_CREAT | os.O_RDWR), 1 << 40)
    print("TRA" "CE", os.path.getsize("/tmp/hostile-408"))
