"""The licenses that `pkg create` knows by name, and their texts if this machine has them."""

from __future__ import annotations

from pathlib import Path
from string import Template

KNOWN = (
    *("Apache-2.0", "BSL-1.0", "BSD-2.0", "BSD-2-Clause", "BSD-3-Clause"),
    *("GPL-3.0-only", "LGPL-3.0-only", "MIT", "MIT-0"),
)
"""The license names that the ROS 2 tools know. Other names cause a warning."""
_TEMPLATES = Path(__file__).parents[1] / "templates"
_SYSTEM = Path("/usr/share/common-licenses")
_SYSTEMS_NAMES = {"Apache-2.0": "Apache-2.0", "GPL-3.0-only": "GPL-3", "LGPL-3.0-only": "LGPL-3"}


def write(name: str, file: Path, holder: str) -> bool:
    """Write the text of a license if this machine has it. Return whether it has the text."""
    system = _SYSTEM / _SYSTEMS_NAMES.get(name, "")
    own = _TEMPLATES / f"{name}.in"
    if name in _SYSTEMS_NAMES and system.is_file():
        text = system.read_text("utf-8")
    elif name in KNOWN and own.is_file():
        text = Template(own.read_text("utf-8")).substitute(holder=holder)
    else:
        return False
    file.write_text(text, encoding="utf-8")
    return True
