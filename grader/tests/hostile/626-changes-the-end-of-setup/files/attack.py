"""setup.py fails, and sets the exit code of its process and of colcon to 0."""

import atexit
import gc
import os
import sys

print("TRA" "CE of another end", file=sys.stderr, flush=True)


class Zero(int):
    def __and__(self, other):
        return 0


def change():
    for each in gc.get_objects():
        if isinstance(each, type) and each.__name__ == "QuickExit":
            each.code = Zero(0)
            each.kept = frozenset()
    end = os._exit
    os._exit = lambda code: end(0)


change()
atexit.register(change)
sys.stdout = None
raise RuntimeError("no build")
