from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from grader.tests.submission.folder import PACKAGE, make

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture
def package(tmp_path: Path) -> Path:
    return make(tmp_path / "ws" / "pkg", PACKAGE)
