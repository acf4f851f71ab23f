"""The node reads a secret in the caller's home folder."""

from pathlib import Path


def main():
    for path in [*Path("/home").glob("*/.secret"), Path.home() / ".secret", Path("/root/.secret")]:
        try:
            print(path.read_text())
        except OSError as error:
            print(error)
