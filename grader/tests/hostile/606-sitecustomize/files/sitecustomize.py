"""Runs in every Python that finds it."""

from pathlib import Path

Path("/tmp/hostile-606").write_text("was here")
