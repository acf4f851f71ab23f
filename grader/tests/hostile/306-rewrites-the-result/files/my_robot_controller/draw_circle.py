"""A process waits for the report and replaces it."""

import os
import time
from pathlib import Path


def main():
    if os.fork():
        return
    os.setsid()
    if os.fork():
        os._exit(0)
    for fd in (0, 1, 2):
        os.close(fd)
    for _ in range(600):
        for report in Path("/tmp").glob("*/report.json"):
            report.write_text('{"points": 100.0}')
            Path("/tmp/hostile-306").write_text("100 points")
            os._exit(0)
        time.sleep(0.05)
