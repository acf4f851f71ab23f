from __future__ import annotations

from pathlib import Path

from grader.tests.conftest import LONGEST


def test_each_module_that_is_started_first_exists() -> None:
    assert [name for name in LONGEST if not (Path(__file__).parent / name).is_file()] == []
