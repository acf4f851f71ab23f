"""A kernel on which no process can enter a sandbox is reported before any work begins."""

from __future__ import annotations

import errno
import os
import subprocess
import sys

import pytest

from grader.sandbox import bpf, bubblewrap, entering
from grader.sandbox.holder import Holder, HolderError

SETNS, PIDFD_OPEN = 308, 434
ON_OLD_KERNEL = """
import sys
from grader.sandbox import entering
entering.confine([], user=None, call_filter=bytes.fromhex(sys.argv[1]))
print(entering.why_impossible())
"""


def why_with(refused: dict[int, int]) -> str:
    """Return the answer of why_impossible on a kernel on which system calls (keys) fail with errors (values)."""
    lines = bpf.begin()
    for call, error in refused.items():
        lines += bpf.refusing([call], error)
    call_filter = bpf.packed([*lines, (bpf.RETURN, 0, 0, bpf.ALLOW)])
    argv = [sys.executable, "-c", ON_OLD_KERNEL, call_filter.hex()]
    return subprocess.run(argv, capture_output=True, text=True, check=True).stdout.strip()


@pytest.mark.skipif(os.uname().machine != "x86_64", reason="the filter that imitates an old kernel is for x86-64")
def test_an_old_kernel_is_named() -> None:
    needs = "It needs Linux 5.8 or later"
    assert why_with({}) == "None"
    assert needs in why_with({SETNS: errno.EINVAL})  # Linux 5.3 to 5.7
    assert needs in why_with({PIDFD_OPEN: errno.ENOSYS})  # before Linux 5.3


def test_a_bubblewrap_that_prints_nothing_is_named() -> None:
    with pytest.raises(HolderError, match="bubblewrap exited without a message"):
        Holder(lambda _: ["sh", "-c", "head -c 1 > /dev/null"]).await_ready()


def test_such_a_kernel_has_no_sandbox(monkeypatch: pytest.MonkeyPatch) -> None:
    assert bubblewrap.why_unavailable() is None
    monkeypatch.setattr(entering, "why_impossible", lambda: "the kernel is too old")
    assert bubblewrap.why_unavailable() == "the kernel is too old"
