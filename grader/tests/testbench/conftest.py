"""The files of the solution, once for all tests of the bench."""

from __future__ import annotations

import pytest

from grader.tests.testbench.bench_runs import solution_files


@pytest.fixture(scope="session")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """Return the files of the solution."""
    return solution_files(tmp_path_factory.mktemp("bench"))
