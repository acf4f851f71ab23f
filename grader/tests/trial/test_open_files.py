from __future__ import annotations

import errno
import resource
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from grader.trial import open_files

SOLUTION = Path(open_files.__file__).parents[2] / "solutions/03-circle-publisher"


def checked(limit: str) -> subprocess.CompletedProcess[str]:
    command = f"{limit}; exec {shlex.quote(str(Path(sys.prefix, 'bin/grader')))} check {shlex.quote(str(SOLUTION))}"
    return subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False)


def test_a_low_limit_that_may_be_raised_is_raised() -> None:
    assert "Passed: 100 of 100 points." in checked("ulimit -S -n 64").stdout


def test_a_low_limit_is_never_the_fault_of_the_node() -> None:
    done = checked("ulimit -n 64")
    assert done.returncode == 3, done.stdout
    assert "cannot open more than 64 files: raise this limit" in done.stdout
    assert "the node made" not in done.stdout


@pytest.mark.parametrize(
    ("error", "limit", "found"),
    [
        (OSError(errno.EMFILE, ""), 64, "cannot open more than 64 files"),
        (OSError(errno.EMFILE, ""), 256, None),
        (OSError(errno.ENFILE, ""), 1024, "too many files open"),
        (OSError(errno.ENOENT, ""), 64, None),
        (ValueError(), 64, None),
    ],
)
def test_too_few_files_are_told_from_a_node_with_many_threads(
    monkeypatch: pytest.MonkeyPatch, error: Exception, limit: int, found: str | None
) -> None:
    monkeypatch.setattr(resource, "getrlimit", lambda _: (limit, limit))
    reported = open_files.lack(error)
    assert (reported is None) if found is None else (reported is not None and found in reported)
