"""Skip a test, or fail in CI, if a program that the test needs is missing."""

from __future__ import annotations

import os
from typing import NoReturn

import pytest


def give_up(program: str, package: str) -> NoReturn:
    """Skip the test with the reason. In CI, where the set-up installs the program, the test fails."""
    reason = f"there is no {program}: apt-get install {package}"
    if os.environ.get("CI") == "true":
        pytest.fail(f"this cannot be tested, since {reason}")
    pytest.skip(reason)
