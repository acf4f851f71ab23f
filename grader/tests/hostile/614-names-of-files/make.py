"""Names that no README shows."""

from pathlib import Path


def make(package: Path) -> None:
    """Make the files, and links that lead nowhere, so that they are told of."""
    for name in ("\x1b[2Jhostile", "<script>alert(1)<script>", "a\n::error::hostile", "$(touch hostile)"):
        (package / name).write_text("")
        (package / (name + ".link")).symlink_to("/" + name.replace("/", ""))
