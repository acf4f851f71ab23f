"""Some file names contain commands. git cannot store such names on every system."""

from pathlib import Path


def make(package: Path) -> None:
    """Make the files, and broken links, so that messages contain their names."""
    for name in ("\x1b[2Jhostile", "<script>alert(1)<script>", "a\n::error::hostile", "$(touch hostile)"):
        (package / name).write_text("")
        (package / (name + ".link")).symlink_to("/" + name.replace("/", ""))
