"""The programs that the page of `grader open` starts and stops."""

from __future__ import annotations

import asyncio
import os

from grader.open.programs import Program
from grader.tests.ros2.world import children


def test_a_double_click_starts_one_process() -> None:
    async def click_twice() -> list[int]:
        before = children(os.getpid())
        program = Program(lambda: None)
        waits = ("-c", "import time; time.sleep(1000)")
        await asyncio.gather(program.start(*waits), program.start(*waits))
        started = [each for each in children(os.getpid()) if each not in before]
        await program.stop()
        assert not program.running
        return started

    assert len(asyncio.run(click_twice())) == 1
