"""setup.py exits at once with code 0."""

import os

print("TRA" "CE of success", flush=True)
os._exit(0)
