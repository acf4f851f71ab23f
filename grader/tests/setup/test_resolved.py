"""Each part of the lock file is complete for every Python: uv needs no other packages for the part.

Each set-up consists of parts that are complete, so every set-up is complete. The test needs the network if packages are
missing in uv's cache.
"""

from __future__ import annotations

import re
import subprocess

import pytest

from grader.setup import lock
from grader.setup.machine import OLDEST
from grader.setup.uv import uv

pytestmark = [pytest.mark.exhaustive, pytest.mark.door]


@pytest.mark.parametrize("part", [part for part in lock.PARTS if part not in lock.ALWAYS])
def test_nothing_is_missing(part: str) -> None:
    text = lock.LOCK_FILE.read_text(encoding="utf-8")
    requirements = lock.select(text, [*lock.ALWAYS, part])
    pythons = f"--universal --python-version {OLDEST[0]}.{OLDEST[1]}"
    options = f"pip compile - {pythons} --no-annotate --no-header --quiet".split()
    done = subprocess.run(uv(*options), cwd="/", input=requirements, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    listed, needed = (
        set(re.findall(r"^[\w.-]+==\S+", packages, re.MULTILINE)) for packages in (requirements, done.stdout)
    )
    assert len(listed) > 60
    assert needed == listed
