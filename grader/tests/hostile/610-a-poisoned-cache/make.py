"""The package contains a compiled file that Python uses without checking the source."""

import importlib.util
import py_compile
from pathlib import Path


def make(package: Path) -> None:
    """Compile another source instead of draw_circle.py."""
    folder = package / "my_robot_controller"
    source = folder / "other.py"
    source.write_text('print("TRACE of the cache")\n')
    target = importlib.util.cache_from_source(str(folder / "draw_circle.py"))
    mode = py_compile.PycInvalidationMode.UNCHECKED_HASH
    py_compile.compile(str(source), target, "draw_circle.py", invalidation_mode=mode)
    source.unlink()
