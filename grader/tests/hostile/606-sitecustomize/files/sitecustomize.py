"""Every Python process that finds this module runs it."""

from pathlib import Path

Path("/tmp/hostile-606").write_text("was here")
