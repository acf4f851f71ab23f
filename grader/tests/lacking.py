"""Skip a test if the machine lacks something that the test needs. In CI, a missing program is a failure."""

from __future__ import annotations

import os
import stat
import sys
from pathlib import Path
from typing import NoReturn

import pytest


def give_up(program: str, package: str) -> NoReturn:
    """Skip the test with the reason. In CI, where the set-up installs the program, the test fails."""
    reason = f"there is no {program}: apt-get install {package}"
    if os.environ.get("CI") == "true":
        pytest.fail(f"this cannot be tested, since {reason}")
    pytest.skip(reason)


def need_reachable_python() -> None:
    """Skip the test if an ordinary user cannot reach this Python, as after `git clone . $(mktemp -d)`, also in CI."""
    for folder in Path(sys.executable).parents:
        if not folder.stat().st_mode & stat.S_IXOTH:
            pytest.skip(f"only the owner of {folder} can enter this folder")
