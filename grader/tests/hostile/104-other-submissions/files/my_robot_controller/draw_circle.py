"""It reads the submissions of others."""

from pathlib import Path


def main():
    for folder in ("/home", "/tmp", "/work", "/srv"):
        for path in Path(folder).glob("*/*/submission.txt"):
            print(path.read_text())
