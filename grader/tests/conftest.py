from __future__ import annotations

import gc
import os
import signal
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import HealthCheck, settings

from grader.ros import installation, underlay
from grader.tests.descriptors import descriptors
from grader.tests.domains import default_domain
from grader.tests.gradings import gradings_of
from grader.tests.in_ros import InRos

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

    from grader.tests.gradings import Gradings

# Tests that are started in the background or by nohup ignore signals, and their child processes inherit this.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)

# No other test process uses this domain.
os.environ["ROS_DOMAIN_ID"] = str(default_domain())
# A daemon would keep running after the test that started it.
os.environ["GRADER_ROS2_DAEMON"] = "0"

# No test fails because the machine is busy.
settings.register_profile("unhurried", deadline=None, max_examples=60, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("unhurried")

collect_ignore = ["cases", "mistakes", "unusual", "hostile"]
"""Folders with submissions. Some of these folders contain tests of their own."""


MOST_LEFT_OPEN = 20
"""The number of descriptors that a test may leave open, for example those of fixtures that later tests use, too."""

LONGEST = (
    *("gradebook/test_forged_scores.py", "gradebook/test_term.py", "test_current_folder.py", "test_mistakes.py"),
    *("authoring/test_validate.py", "test_hostile.py", "test_lessons.py", "test_cases.py", "docs/test_commands.py"),
    *(
        "classroom/test_kill.py",
        "test_hostile_class.py",
        "test_unusual.py",
        "open/test_survival.py",
        "open/test_story.py",
    ),
    *("view/test_view_page.py", "grading/test_grade.py", "ros/test_underlay.py", "ros2/test_bag.py"),
)
"""The slowest modules. `make test` starts them first, so that all processes finish at about the same time."""


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Collect without the garbage collector, which would search the growing list of tests again and again.

    The collected tests exist until the end of the session, so later runs of the garbage collector skip them.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Sort the modules: the slowest modules first, and all other modules in their original order.

    The time limit of pyproject.toml is not for exhaustive tests.
    """
    places = {Path(__file__).parent / name: place for place, name in enumerate(LONGEST)}
    items.sort(key=lambda item: places.get(item.path, len(LONGEST)))
    for item in items:
        if item.get_closest_marker("exhaustive") and not item.get_closest_marker("timeout"):
            item.add_marker(pytest.mark.timeout(0))  # such a test may take hours


@pytest.fixture(autouse=True)
def _no_blocked_signals() -> Iterator[None]:
    """Check that no test leaves signals blocked, which all later child processes of this process would inherit."""
    yield
    left = signal.pthread_sigmask(signal.SIG_SETMASK, ())
    assert not left, f"this test leaves signals blocked: {left}"


@pytest.fixture(autouse=True)
def _no_open_files(request: pytest.FixtureRequest) -> Iterator[None]:
    """Check that no test leaves many descriptors open. pexpect needs descriptors below 1024 (see select(2)).

    Tests with the mark `clocks`, and the other tests of their modules, are not checked, because other cases are being
    graded in the meantime.
    """
    before = descriptors()
    yield
    left = len(descriptors() - before)
    in_background = hasattr(request.module, "all_graded_here") or request.node.get_closest_marker("clocks")
    if not in_background:
        assert left <= MOST_LEFT_OPEN, f"this test leaves {left} descriptors open"


@pytest.fixture(scope="session")
def in_ros(tmp_path_factory: pytest.TempPathFactory) -> InRos:
    """Processes with ROS 2 and the turtlesim interfaces. The interfaces are built on first use."""
    home: Path = tmp_path_factory.mktemp("ros")
    return InRos(underlay.with_turtlesim(installation.find_ros()), home)


@pytest.fixture(scope="module")
def gradings(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Gradings]:
    """The results of all cases that the tests of this module mark with `clocks`. The cases are graded in parallel."""
    yield from gradings_of(request, tmp_path_factory)
