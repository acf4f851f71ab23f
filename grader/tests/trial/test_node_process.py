from __future__ import annotations

import fcntl
import os
from contextlib import suppress

import pytest

from grader.trial.node_process import FULL, PIPE, Stream


@pytest.mark.parametrize("size", [1, 100, 2049, 4095, 4097, 100_000])
def test_whom_a_full_pipe_keeps_waiting_has_written_enough_to_be_noticed(size: int) -> None:
    reads, writes = os.pipe2(os.O_NONBLOCK)
    try:
        fcntl.fcntl(writes, fcntl.F_SETPIPE_SZ, PIPE)
        with suppress(BlockingIOError):
            while True:
                os.write(writes, b"x" * size)
        assert Stream(reads).read(0.0) >= FULL
        assert Stream(reads).read(0.0) == 0
    finally:
        os.close(reads)
        os.close(writes)
