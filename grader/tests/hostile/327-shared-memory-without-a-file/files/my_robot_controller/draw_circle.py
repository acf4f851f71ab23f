"""The node allocates shared memory that counts towards neither a file system nor a process."""

import mmap


def allocate(file):
    memory = mmap.mmap(file, 4096)
    memory[:] = bytes(4096)
    memory.madvise(mmap.MADV_DONTNEED)  # the pages stay in memory
    print("TRA" "CE of shared memory")


def main():
    try:
        allocate(-1)
    except OSError as error:
        print(error)
    try:
        with open("/dev/zero", "r+b") as zero:
            allocate(zero.fileno())
    except OSError as error:
        print(error)
