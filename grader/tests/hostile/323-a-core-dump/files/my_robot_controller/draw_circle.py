"""The node crashes with a core dump, which the kernel may pass to a program that runs as root.

The kernel passes it on whatever the limit is, unless the limit is 1: core(5), "Piping core dumps to a program".
"""

import resource


def main():
    _, most = resource.getrlimit(resource.RLIMIT_CORE)
    resource.setrlimit(resource.RLIMIT_CORE, (most, most))
    print("TRA" "CE of a core dump" if resource.getrlimit(resource.RLIMIT_CORE)[0] != 1 else "no core dump")


if __name__ == "__main__":
    main()
