"""Run the tests in grader/tests/checks that cover a mutant's lines."""

from __future__ import annotations

import multiprocessing
from typing import TYPE_CHECKING

import pytest

from grader.tests.case import ROOT

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Iterator
    from pathlib import Path

    from grader.tests.mutation.judging import Lines

TESTS = ROOT / "grader" / "tests" / "checks"
QUIET = ("-q", "-p", "no:cacheprovider", "-W", "ignore", "--rootdir", str(ROOT))


def touched(files: Collection[Path]) -> Lines:
    """Return the tests that run each line of these files. Lines are counted from 1."""
    # This runs in a child process, since each mutant needs new imports of all modules that the tests import.
    with multiprocessing.get_context("fork").Pool(1) as pool:
        return pool.apply(_measured, (sorted(files),))


def fail(tests: Iterable[str]) -> bool:
    """Return whether one of these tests fails or cannot be collected."""
    names = [f"{ROOT / test}" for test in sorted(tests)]
    return bool(names) and pytest.main([*QUIET, "-x", *names]) != pytest.ExitCode.OK


def _measured(files: Iterable[Path]) -> Lines:
    from coverage import Coverage

    from grader.tests.mutation.judging import lines_of

    measured = Coverage(data_file=None, include=[str(file) for file in files], config_file=False)
    measured.start()
    pytest.main([*QUIET, str(TESTS)], plugins=[_Contexts(measured)])
    measured.stop()
    return lines_of(measured, files)


class _Contexts:
    """Tells the coverage measurement which test is running."""

    def __init__(self, measured: object) -> None:
        self._measured = measured

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        self._measured.switch_context(item.nodeid)  # type: ignore[attr-defined]
        return (yield)
