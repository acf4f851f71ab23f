"""setup.py leaves a file in /tmp."""

from pathlib import Path

Path("/tmp/hostile-301").write_text("was here")
