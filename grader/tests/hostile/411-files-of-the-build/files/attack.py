"""setup.py keeps creating empty files."""

import os

os.makedirs("many", exist_ok=True)
for _count in range(300_000):
    os.close(os.open(f"many/{_count}", os.O_CREAT | os.O_WRONLY))
print("TRA" "CE 300000 files")
