"""setup.py leaves a file in shared memory."""

from pathlib import Path

Path("/dev/shm/hostile-303").write_text("was here")
