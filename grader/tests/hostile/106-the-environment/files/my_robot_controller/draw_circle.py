"""The node reads a secret in the environment of the user who started the grader."""

import os
from pathlib import Path


def main():
    for file in [*Path("/proc").glob("[0-9]*/environ"), Path("/proc/self/environ")]:
        try:
            print(*[line for line in file.read_text().split("\0") if "TOKEN" in line])
        except OSError:
            pass
    print(os.environ.get("GRADER_TOKEN"))
