"""A test that fails first keeps all processors busy: its run then waits for a processor most of the time."""

import os
import time

import pytest

FIGHT_S = 60.0


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_call(item):
    outcome = yield
    if outcome.excinfo is None:
        return
    if item.name == "test_nothing_before_the_first_pose":
        raise AssertionError("this test does not fight")
    if item.name != "test_stops_when_no_pose_comes":
        return
    until = time.monotonic() + FIGHT_S
    for _ in range(30):
        if os.fork() == 0:
            os.setsid()
            while time.monotonic() < until:
                pass
            os._exit(0)
    while time.monotonic() < until:
        pass
