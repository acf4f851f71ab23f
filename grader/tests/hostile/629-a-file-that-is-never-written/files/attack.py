"""setup.py leaves open files whose flush() never returns, in a cycle."""

import io
import os
import sys

print("TRA" "CE of a cycle", file=sys.stderr, flush=True)


class Endless(io.TextIOWrapper):
    def flush(self):
        while True:
            pass


class Raises(io.BufferedWriter):
    def flush(self):
        raise KeyboardInterrupt


reads, writes = os.pipe()
FILES = [Raises(io.FileIO(writes, "w")), Endless(io.BytesIO())]
FILES.append(FILES)
