"""The node reads the submissions of other students."""

from pathlib import Path


def main():
    for folder in ("/home", "/tmp", "/work", "/srv"):
        for path in Path(folder).glob("*/*/submission.txt"):
            print(path.read_text())
