"""The node keeps opening files."""

import os
import resource


def main():
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
    for _ in range(2000):
        os.open("/dev/null", os.O_RDONLY)
    print("TRA" "CE 2000 descriptors")
