"""The node locks memory, and looks for the right to run before all other programs."""

import ctypes
import mmap
import resource

PRIORITIES = (resource.RLIMIT_RTPRIO, resource.RLIMIT_NICE)


def main():
    area = mmap.mmap(-1, mmap.PAGESIZE, flags=mmap.MAP_PRIVATE)
    where = ctypes.c_void_p(ctypes.addressof(ctypes.c_char.from_buffer(area)))
    locked = ctypes.CDLL(None).mlock(where, mmap.PAGESIZE) == 0
    if locked or any(resource.getrlimit(which)[1] != 0 for which in PRIORITIES):
        print("TRA" "CE")
    else:
        print("refused")
