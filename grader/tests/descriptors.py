"""The descriptors that this process has open, for tests that nothing is left open."""

from __future__ import annotations

import os


def descriptors() -> set[str]:
    """Return the numbers of all open descriptors. One of them belongs to the listing itself."""
    return set(os.listdir("/proc/self/fd"))  # noqa: PTH208 (iterdir may open the folder later)
