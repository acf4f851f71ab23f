"""A package written on Windows: all text files have CRLF line endings, and Python files have a byte order mark."""
from pathlib import Path


def make(folder: Path) -> None:
    for file in folder.rglob("*"):
        if file.is_file() and file.suffix in (".py", ".xml", ".cfg"):
            mark = b"\xef\xbb\xbf" if file.suffix == ".py" else b""
            file.write_bytes(mark + file.read_bytes().replace(b"\n", b"\r\n"))
