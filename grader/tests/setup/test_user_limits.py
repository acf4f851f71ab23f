from __future__ import annotations

import resource
import subprocess
import sys

import pytest

from grader.sandbox.limits import MIB
from grader.setup import user_limits

SAYS = "from grader.setup.user_limits import shares; print(*shares(), sep='|')"


def test_the_limit_of_open_files_is_reported() -> None:
    files = resource.getrlimit(resource.RLIMIT_NOFILE)[0]
    assert user_limits.shares()[0].startswith(f"{files} open files, ")


@pytest.mark.parametrize(
    ("option", "todo"),
    [
        ("--nofile=200:", "ulimit -n 1024"),
        ("--nproc=900:", "ulimit -u 4096"),
        (f"--as={1500 * MIB}:", "ulimit -v unlimited"),
        (f"--as={1500 * MIB}", "ulimit -v unlimited"),
    ],
)
def test_too_few_are_reported_with_what_to_do(option: str, todo: str) -> None:
    done = subprocess.run(["prlimit", option, sys.executable, "-c", SAYS], capture_output=True, text=True, check=True)
    assert done.stdout.strip().partition("|")[2] == todo


def test_pipes_that_may_not_grow_are_reported_and_need_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(user_limits, "enlarge", lambda _: 65536)
    observed, todo = user_limits.shares()
    assert ("pipes stay small" in observed, todo) == (True, "")
